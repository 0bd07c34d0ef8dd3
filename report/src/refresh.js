/** What a page that reads itself again must not lose: where its reader is, and what they have opened. */

/** @returns {{scroll: number, open: number[]}} */
const state = () => ({
  scroll: scrollY,
  open: [...document.querySelectorAll('details')].flatMap((details, k) => (details.open ? [k] : [])),
});

/** @param {{scroll: number, open: number[]}} kept */
function restore(kept) {
  document.querySelectorAll('details').forEach((details, k) => (details.open = kept.open.includes(k)));
  scrollTo({ top: kept.scroll, behavior: 'instant' });
}

/**
 * Reads the page again every so often while the command that writes it is at work. The entry of the window's history
 * carries the state over: a page that was opened as a file has no other memory that every browser gives it.
 * @param {{refresh?: number}} report seconds; 0: never
 */
export function keepUpToDate({ refresh = 0 }) {
  if (history.state?.posewright) {
    const kept = history.state.posewright;
    history.replaceState(null, '');
    requestAnimationFrame(() => restore(kept));
  }
  if (!(refresh > 0)) return;
  history.scrollRestoration = 'manual';
  setTimeout(function again() {
    // Nobody looks at a hidden page; the one that they come back to is read at once.
    if (document.hidden) return document.addEventListener('visibilitychange', again, { once: true });
    history.replaceState({ posewright: state() }, '');
    location.reload();
  }, 1000 * refresh);
}
