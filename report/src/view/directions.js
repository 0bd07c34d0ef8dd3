/** Directions from which one looks, as seen from the middle. */
export const directions = { free: [0.75, -1, 0.6], top: [0, -1e-3, 1], front: [1, 0, 0.02], side: [0, -1, 0.02] };
