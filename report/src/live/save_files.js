import { nameOf } from './project.js';

/** @param {string} path of which the name is taken @param {Uint8Array|string} bytes */
export function saveFile(path, bytes) {
  const url = URL.createObjectURL(new Blob([bytes]));
  Object.assign(document.createElement('a'), { href: url, download: nameOf(path) }).click();
  setTimeout(() => URL.revokeObjectURL(url), 60_000);
}
