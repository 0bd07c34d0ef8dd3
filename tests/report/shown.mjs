// What a page of a result shows, as numbers and texts.

/** A number as the pages write it. @param {string} text */
export const read = (text) =>
  Number.parseFloat(
    text
      .replace(/−/g, '-')
      .replace(/ · 10\^/, 'e')
      .replace(/,/g, '')
      .replace(/^[^\d-]*/, ''),
  );

/** Rows of a table by its label, as texts. @param {any} page @param {string} label */
export const rowsOf = (page, label) =>
  page.locator(`[aria-label="${label}"] tbody tr`).evaluateAll((rows) => rows.map((row) => [...row.cells].map((cell) => cell.textContent)));

/** @param {any} page @param {string} id @returns {Promise<number[][]>} */
export const plotted = (page, id) => page.locator(`#${id}`).evaluate((f) => f.plot.data.map((s) => [...s]));

export const mm = 1e3;
