/** Error to expect with the usual size of an effect, m. @param {any} expected expected_error of a result @returns {number} */
export const usualError = (expected) => expected.with[expected.with.length >> 1].error;
