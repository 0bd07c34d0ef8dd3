import { h } from '../dom.js';
import { onTheme } from '../theme.js';
import { cameraLines } from './camera_lines.js';
import { placeLabels } from './labels.js';
import { Picture } from './picture.js';
import { kindNames, kindOf, countsOf, reasonAt } from './verdicts.js';
import { beams } from './sights.js';
import { makeView } from './viewer.js';
import { layerBoxes, lookButtons } from './viewer_controls.js';

/** A problem without a plan: its cell, and the robot at configurations of every verdict. */
export class CellViewer {
  constructor() {
    this.layers = { bodies: true, sights: true, candidates: false };
    this.holder = h('div', { class: 'view' });
    this.labels = h('div', { class: 'labels', 'aria-hidden': 'true' });
    this.slider = h('input', { type: 'range', min: 0, value: 0, 'aria-label': 'Configuration shown', oninput: () => this.go(Number(this.slider.value)) });
    this.said = h('output', { class: 'stop', 'aria-live': 'polite' });
    this.tools = h('div', { class: 'tools' });
    this.legend = h('ul', { class: 'verdicts' });
    const step = (by) => () => this.go(this.place + by);
    this.element = h(
      'div',
      { class: 'viewer' },
      this.holder,
      h('div', { class: 'player' }, h('button', { onclick: step(-1), 'aria-label': 'Previous configuration' }, '‹ Back'), h('button', { onclick: step(1), 'aria-label': 'Next configuration' }, 'Next ›'), this.slider),
      this.said,
      this.tools,
      this.legend,
    );
    this.place = 0;
    onTheme(() => this.view && (this.view.paint(), this.#draw()));
  }

  /** @param {any} report of a problem */
  show(report) {
    const old = this.view && { view: this.view, sizes: this.sizes, title: this.report.title };
    this.report = report;
    this.picture = new Picture(report, (id) => `verdict-${kindOf(reasonAt(report, id))}`);
    this.all = new Set(this.picture.tips.map((tip) => tip.id));
    Object.assign(this, makeView(this.holder, this.picture, (id) => this.go(id)));
    this.view.onDraw = (project) => placeLabels(this.labels, this.picture, { current: null }, undefined, this.view.legend, project);
    if (old?.title === report.title) this.view.lookLike(old.view);
    old?.sizes.disconnect();
    old?.view.dispose();
    this.holder.append(this.labels);
    this.slider.max = String(report.keyframes.length - 1);
    this.tools.replaceChildren(lookButtons(this.view, this.picture), layerBoxes(report, this.layers, () => this.#draw()));
    this.legend.replaceChildren(...this.#counts());
    this.go(Math.min(this.place, report.keyframes.length - 1));
  }

  #counts() {
    const { evenly } = this.report;
    return countsOf(this.report).map(({ reason, kind, count }) =>
      h('li', {}, h('span', { class: `dot ${kind}` }), h('b', {}, `${Math.round((100 * count) / evenly)} %`), ` ${reason ?? kindNames.feasible}`),
    );
  }

  /** @param {number} place 0: home */
  go(place) {
    this.place = Math.max(0, Math.min(this.report.keyframes.length - 1, place));
    this.slider.value = String(this.place);
    const reason = reasonAt(this.report, this.place);
    const by = this.report.keyframes[this.place]?.instrument;
    this.said.replaceChildren(
      h('span', { class: `dot ${kindOf(reason)}` }),
      ` ${this.place === 0 ? 'Home' : `Configuration ${this.place}`}${by ? ` for ${by}` : ''}: ${reason ?? kindNames.feasible}`,
    );
    this.#draw();
  }

  #draw() {
    const { report, picture, place } = this;
    const drawn = picture.enlargedDrawing(report.keyframes[place]);
    const kind = kindOf(reasonAt(report, place));
    this.view.show({
      drawn,
      sights: drawn ? beams(report, drawn.targets, kind === 'sight') : [],
      current: place,
      on: this.all,
      nearest: [],
      gap: undefined,
      camera: drawn && cameraLines(report, drawn),
      layers: this.layers,
    });
  }
}
