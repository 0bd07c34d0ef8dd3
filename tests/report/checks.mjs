// What must hold, by name; all of it is run, and all that fails is told.
let failed = 0,
  passed = 0,
  subject = '';

/** @param {string} name of what the following checks are about */
export const about = (name) => (subject = name);

/** @param {boolean} holds @param {string} what @param {any} [seen] */
export function check(holds, what, seen = '') {
  if (holds) passed += 1;
  else {
    failed += 1;
    console.log(`FAILED  ${subject}: ${what}${seen === '' ? '' : `; seen: ${seen}`}`);
  }
}

/** @param {number} value @param {number} expected @param {number} tolerance relative @param {string} what */
export const near = (value, expected, tolerance, what) =>
  check(
    Math.abs(value - expected) <= tolerance * Math.max(Math.abs(expected), 1e-12),
    what,
    `${value}, expected ${expected}`,
  );

export function verdict() {
  console.log(`${passed} checks hold, ${failed} do not.`);
  return failed === 0 ? 0 : 1;
}
