import { h } from '../../dom.js';
import { dropZone } from '../dropped.js';
import { folderOf, joined, nameOf } from '../project.js';
import { added } from '../things.js';
import { addButtons, thingsPanel } from '../things_panel.js';

/** @param {import('../main.js').Live} live */
export function cellStep(live) {
  const { project } = live;
  const take = (files) => {
    const meshes = [...files].filter(([path]) => /\.(stl|obj|dae)$/i.test(path));
    if (meshes.length === 0) return live.complain('A body of the cell is a mesh: .stl, .obj or .dae.');
    project.add(meshes.map(([path, bytes]) => [joined(folderOf(project.problem), nameOf(path)), bytes]));
    project.write(meshes.reduce((text, [path]) => added(text, 'mesh', [1, 0, 0], nameOf(path)), project.text));
  };
  return h(
    'div',
    {},
    addButtons(project),
    dropZone({ label: 'Choose meshes', hint: 'Drop meshes of tables, walls, fixtures (m; key scale for mm).', take, complain: live.complain }),
    thingsPanel(project, 'cell'),
  );
}
