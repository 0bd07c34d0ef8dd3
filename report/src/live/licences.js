import { h } from '../dom.js';
import { unpackedText } from './unpack.js';

/** The licences of the program and of the libraries in this page, unpacked when someone asks for them. */
export function licences() {
  const dialog = /** @type {HTMLDialogElement} */ (document.getElementById('licences'));
  document.getElementById('licences-open').addEventListener('click', async () => {
    dialog.replaceChildren(h('button', { autofocus: true, onclick: () => dialog.close() }, 'Close'), h('pre', { tabindex: '0' }, await unpackedText('licence-texts')));
    dialog.showModal();
  });
}
