import { h } from '../../dom.js';
import { dropZone } from '../dropped.js';
import { folderOf, joined, nameOf } from '../project.js';
import { hasMesh, placeMeshes, planAmong, problemsAmong, robotAmong } from '../robot_files.js';

/**
 * @param {import('../main.js').Live} live
 * @param {{title: string, files: Record<string, string>, problem: string}[]} examples
 */
export function robotStep(live, examples) {
  const say = h('p', { class: 'note', role: 'status' });
  const take = async (files) => {
    const [problem, ...others] = problemsAmong(files);
    const plan = planAmong(files);
    const all = new Map([...live.project.given, ...files]);
    const isPlanOf = (path) => [joined(folderOf(path), 'plan.json'), files.get(plan)];
    if (problem) {
      live.complain('');
      say.textContent = others.length === 0 ? `${problem} is read.` : `${problem} is read; so can be ${others.slice(0, 5).join(', ')}${others.length > 5 ? ', …' : ''}: drop one alone.`;
      all.delete(plan);
      const made = plan ? [isPlanOf(problem)] : [];
      const text = new TextDecoder().decode(files.get(problem));
      live.project.open(new Map([...all, ...made]), problem, new Map(made.map(([path]) => [path, text])));
      return plan && live.showPlan();
    }
    if (files.size === 1 && plan) {
      if (live.project.text === '') return live.complain('A plan needs its problem file: drop it with the problem file and the robot.');
      live.complain('');
      live.project.add([isPlanOf(live.project.problem)], live.project.text);
      return live.showPlan();
    }
    const robot = robotAmong(files) ?? (hasMesh(files) ? live.robotOf() : undefined);
    if (!robot || !all.has(robot)) return live.complain('Among these files is no robot: a URDF (or the output of xacro) has <robot> at its beginning.');
    const { missing, looks } = placeMeshes(all, robot);
    const read = await live.begin(all, robot);
    say.textContent = !read
      ? ''
      : missing.length > 0
        ? `${robot}: ${missing.length} of its meshes are missing (${missing.slice(0, 3).map(nameOf).join(', ')}${missing.length > 3 ? ', …' : ''}); drop them or their folder here. The notes tell what is left out without them.`
        : looks.length > 0
          ? `${robot} is read. Meshes for its looks alone are missing (${looks.length}): it is drawn as it is checked.`
          : `${robot} is read.`;
  };
  const example = h(
    'select',
    {
      'aria-label': 'Example',
      onchange: () => {
        const chosen = examples[example.selectedIndex - 1];
        if (!chosen) return;
        const encoder = new TextEncoder();
        const files = new Map(Object.entries(chosen.files).map(([path, text]) => [path, encoder.encode(text)]));
        say.textContent = '';
        live.complain('');
        if (chosen.problem) return live.project.open(files, chosen.problem);
        return take(files);
      },
    },
    h('option', {}, 'Choose an example…'),
    examples.map((e) => h('option', {}, e.title)),
  );
  return h(
    'div',
    {},
    dropZone({ label: 'Choose files', hint: 'Drop a URDF with its meshes, a folder with both, or a problem file, maybe with its plan.json.', take, complain: live.complain, folder: true }),
    h('p', {}, 'or ', example),
    say,
    h('p', { class: 'note' }, 'Nothing leaves this page: the program runs inside it, without network.'),
  );
}
