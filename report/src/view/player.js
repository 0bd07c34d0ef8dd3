import { between } from './interpolate.js';

/** Long waits and long ways are shortened to this while playing, s. */
const longestStep = 2;
/** Time a stop is shown where there is no route, s. */
const dwell = 0.9;

/**
 * Steps through keyframes: all of the route, or only the stops where there is none or the list differs from it.
 * Events: "frame" when what is shown changes, "state" on play, pause and a new sequence.
 */
export class Player extends EventTarget {
  /** @param {import('../pose_list.js').PoseList} list */
  constructor(list) {
    super();
    this.list = list;
    this.place = 0;
    this.playing = false;
    this.rebuild();
  }

  rebuild() {
    const shown = this.list.current;
    const { keyframes, route } = this.list.report;
    this.routed = Boolean(route) && !this.list.changed;
    this.sequence = this.routed
      ? keyframes
      : this.list.ids.map((id) => this.list.keyframes.get(id)).filter((k) => k !== undefined);
    this.stops = this.sequence
      .map((k, index) => ({ id: k.pose, index }))
      .filter((s, k, all) => s.id && all.findIndex((other) => other.id === s.id) === k);
    const at = this.stops.find((s) => s.id === shown);
    this.go(at ? at.index : Math.min(this.place, this.last));
    this.dispatchEvent(new Event('state'));
  }

  get last() {
    return Math.max(0, this.sequence.length - 1);
  }

  /** Where the robot is now. */
  get drawn() {
    const k = Math.min(this.last, Math.floor(this.place));
    const [a, b] = [this.sequence[k], this.sequence[Math.min(this.last, k + 1)]];
    return this.routed && a ? between(a, b, this.place - k) : a;
  }

  /** The keyframe that is being shown or was passed last. */
  get keyframe() {
    return this.sequence[Math.min(this.last, Math.floor(this.place))];
  }

  /** The pose at which the robot stands; null on the way and at home. */
  get pose() {
    return this.place === Math.floor(this.place) ? this.keyframe?.pose || null : null;
  }

  /** @param {number} place index into the sequence, in between too */
  go(place) {
    this.place = Math.min(this.last, Math.max(0, place));
    this.list.show(this.pose);
    this.dispatchEvent(new Event('frame'));
  }

  /** @param {number} id of a pose */
  goTo(id) {
    const stop = this.stops.find((s) => s.id === id);
    if (stop) this.go(stop.index);
    return Boolean(stop);
  }

  /** To the next stop, or the one before. @param {1|-1} direction */
  step(direction) {
    const ahead = this.stops.filter((s) => (s.index - this.place) * direction > 1e-9);
    const next = direction > 0 ? ahead[0] : ahead.at(-1);
    if (next) this.go(next.index);
  }

  toggle() {
    this.playing = !this.playing;
    if (this.playing) {
      if (this.place >= this.last) this.go(0);
      let before = performance.now();
      const tick = (now) => {
        if (!this.playing) return;
        this.#advance((now - before) / 1000);
        before = now;
        requestAnimationFrame(tick);
      };
      requestAnimationFrame(tick);
    }
    this.dispatchEvent(new Event('state'));
  }

  /** @param {number} seconds */
  #advance(seconds) {
    let place = this.waited ?? this.place;
    while (seconds > 0 && place < this.last) {
      const k = Math.floor(place);
      const length = this.#length(k);
      const rest = (k + 1 - place) * length;
      place = rest <= seconds ? k + 1 : place + seconds / length;
      seconds -= rest;
    }
    // Without a route nothing is known of the way: the robot is shown at stops alone.
    this.waited = this.routed ? null : place;
    const shown = this.routed ? place : Math.floor(place);
    if (shown !== this.place) this.go(shown);
    if (place >= this.last) {
      this.waited = null;
      this.toggle();
    }
  }

  /** Seconds of playing from keyframe k to the next. @param {number} k */
  #length(k) {
    if (!this.routed) return dwell;
    return Math.max(1e-3, Math.min(longestStep, this.sequence[k + 1].seconds - this.sequence[k].seconds));
  }
}
