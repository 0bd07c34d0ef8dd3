/** Parts of the page that are packed (deflate, base64). @param {string} id of the element @returns {Promise<ArrayBuffer>} */
export async function unpackedBytes(id) {
  const packed = document.getElementById(id).textContent;
  const bytes = Uint8Array.from(atob(packed), (c) => c.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'))).arrayBuffer();
}

/** @param {string} id */
export const unpackedText = async (id) => new TextDecoder().decode(await unpackedBytes(id));
