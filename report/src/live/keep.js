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

/** @param {{files: Map<string, Uint8Array>, problem: string}} project */
export const keep = (project) => inStore('readwrite', (objects) => objects.put(project, store));
/** @returns {Promise<{files: Map<string, Uint8Array>, problem: string}|undefined>} */
export const kept = () => inStore('readonly', (objects) => objects.get(store));
