import { h } from '../dom.js';

/** Colours in base.css; further instruments begin again. */
const colours = 6;

/** A colour for each instrument of a plan whose poses are read by more than one. */
export class InstrumentColours {
  /** @param {any} plan */
  constructor(plan) {
    this.names = (plan.instruments ?? []).map((i) => i.name);
    if (this.names.length < 2) this.names = [];
  }

  /** @param {any} pose @returns {string|undefined} name of the colour of its instrument */
  of(pose) {
    const place = this.names.indexOf(pose?.instrument);
    return place < 0 ? undefined : `instrument-${(place % colours) + 1}`;
  }

  /** Each instrument with its colour and its share of the poses that are ticked. @param {import('../pose_list.js').PoseList} list */
  legend(list) {
    if (this.names.length === 0) return null;
    const element = h('ul', { class: 'verdicts instruments', 'aria-label': 'Instruments' });
    const fill = () =>
      element.replaceChildren(
        ...this.names.map((instrument) => {
          const count = list.ids.filter((id) => list.poses.get(id).instrument === instrument).length;
          return h('li', {}, h('span', { class: `dot ${this.of({ instrument })}` }), h('b', {}, instrument), ` ${count} ${count === 1 ? 'pose' : 'poses'}`);
        }),
      );
    list.addEventListener('list', fill);
    fill();
    return element;
  }
}
