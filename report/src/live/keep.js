/** The project in the browser's own storage of this page. Where there is none, nothing is kept and nothing breaks. */
const store = 'project';

/** @returns {Promise<IDBDatabase>} */
const database = () =>
  new Promise((resolve, reject) => {
    const request = indexedDB.open('posewright', 1);
    request.onupgradeneeded = () => request.result.createObjectStore(store);
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
  });

/** @param {IDBTransactionMode} mode @param {(objects: IDBObjectStore) => IDBRequest} work */
async function inStore(mode, work) {
  try {
    const objects = (await database()).transaction(store, mode).objectStore(store);
    return await new Promise((resolve, reject) => {
      const request = work(objects);
      request.onsuccess = () => resolve(request.result);
      request.onerror = () => reject(request.error);
    });
  } catch {
    return undefined;
  }
}

/** @typedef {{files: Map<string, Uint8Array>, problem: string, made: Map<string, string>}} Kept of a project.js */

/** @param {Kept} project */
export const keep = (project) => inStore('readwrite', (objects) => objects.put(project, store));
/** @returns {Promise<Kept|undefined>} */
export const kept = () => inStore('readonly', (objects) => objects.get(store));
