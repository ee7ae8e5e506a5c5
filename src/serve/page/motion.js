// The motion from a start that can be dragged, or that of a trace: in the phase plane and in time.

import { stopped } from "./asked.js";
import { element, terms, warned } from "./dom.js";
import { titleOf } from "./frame.js";
import { Newest } from "./newest.js";
import { drawPhase, linesIn, phaseScales } from "./plots.js";
import { told, withUnit } from "./scale.js";

/** Points of a line that are drawn; more cannot be told apart. */
const MOST_DRAWN = 6000;
const REST = [0, 0];
/** After this a motion is given up for one from another start, in milliseconds. */
const PATIENCE = 500;
const OF_TRACE = "Phase plane of the trace";
const FORMER = "What is shown is of the start before; the motion from this one is not there yet.";

export class MotionCard {
  /**
   * @param {object} source see source.js
   * @param {{moved: (start: number[]) => void, heard: (asked: object) => void,
   *   words: (error: Error) => string}} told of: where a start was moved to, an answer, an error
   */
  constructor(source, { moved, heard, words }) {
    Object.assign(this, { moved, heard, words });
    this.phase = element("phase");
    this.label = this.phase.getAttribute("aria-label");
    this.start = REST;
    /** The motion of a trace, which has no other start. */
    this.stored = null;
    /** The case without its start, and the last answer: to which text and start, and what. */
    [this.text, this.last, this.wanted] = [null, {}, null];
    const ask = async ({ text, asked }, signal) => {
      try {
        return { text, asked, motion: await source.motion(asked, signal) };
      } catch (error) {
        if (error.name === "AbortError") throw error;
        return { text, asked, error };
      }
    };
    const show = (answer) => {
      if (answer.text !== this.text) return;
      [this.last, this.wanted] = [answer, null];
      heard(answer);
    };
    this.requests = new Newest(ask, show, () => {}, { patience: PATIENCE });
    this.#listen();
    new ResizeObserver(() => this.#draw()).observe(this.phase);
  }

  /**
   * Follows the motion of a case, without its start; none: there is no law.
   * @param {string | null} text
   * @param {number[] | null} start
   * @param {object | null} stored the motion of a trace: then the case is the whole one, and
   *   nothing is followed
   */
  look(text, start, stored = null) {
    this.stored = stored;
    this.phase.setAttribute("aria-label", stored ? OF_TRACE : this.label);
    if (stored) {
      const { x_dot: u, a } = stored.arrays;
      [this.text, this.start] = [text, [u[0], a[0]]];
      this.last = { text, asked: text, motion: stored };
      this.#ask();
      return;
    }
    if (text !== this.text) {
      this.requests.stop();
      this.wanted = null;
    }
    this.text = text;
    // A start that is held is nobody else's.
    if (!this.dragging) this.start = start ?? REST;
    this.#ask();
  }

  /** The case file of what is shown. */
  case() {
    if (this.stored) return this.text;
    const [u, a] = this.start;
    return `${this.text}\n[start]\nx_dot0 = ${u}\na0 = ${a}\n`;
  }

  /** Nobody waits for the motion any more. */
  stop() {
    if (!this.pending) return;
    this.requests.stop();
    this.wanted = null;
    this.last = { text: this.text, asked: this.case(), error: stopped() };
    this.heard(this.last);
  }

  /** Asks for the same motion anew. */
  again() {
    this.last = {};
    this.#ask();
  }

  /** Whether the motion from the start is not known yet. */
  get pending() {
    return this.text !== null && (this.last.asked !== this.case() || Boolean(this.last.lost));
  }

  #ask() {
    this.#tellStart();
    const asked = this.case();
    if (this.wanted === asked) return;
    if (!this.pending) {
      // It is known; another one that is under way is not to take its place.
      this.requests.stop();
      this.wanted = null;
      return;
    }
    this.wanted = asked;
    this.requests.want({ text: this.text, asked });
  }

  #tellStart() {
    for (const [id, at] of [
      ["start-u", 0],
      ["start-a", 1],
    ]) {
      const input = element(id);
      input.disabled = Boolean(this.stored);
      if (document.activeElement !== input) input.value = this.start[at];
    }
  }

  /** Shows what is known. */
  tell() {
    const { text, last } = this;
    element("motion").hidden = text === null;
    element("motion-none").hidden = text !== null;
    const ours = text !== null && last.text === text;
    const error = ours && !this.pending ? last.error : null;
    element("motion-problem").textContent = error ? this.words(error) : "";
    const motion = (ours && last.motion) || null;
    // Of another case nothing is left to be seen; of another start only while it is moved.
    element("motion").classList.toggle("blank", !motion);
    element("motion").classList.toggle("failed", Boolean(error));
    element("outcome").classList.toggle("asking", this.pending);
    element("motion-stale").textContent = motion && this.pending ? FORMER : "";
    if (motion === this.motion) return;
    this.motion = motion;
    if (motion) this.#show(motion);
    else terms(element("outcome"), []);
  }

  #show(motion) {
    this.scales = (this.dragging && this.scales) || phaseScales(motion.arrays, this.start);
    this.#draw();
    const { outcome, decided, settle_time: settle, n_min: load, period } = motion;
    const time = (t, digits) => withUnit(told(t, digits), motion.unit_t);
    terms(element("outcome"), [
      ["outcome", `${outcome}, known at t = ${time(decided, 5)}`],
      ["settles after", settle === null ? "never" : time(settle, 6)],
      ["smallest load", withUnit(told(load, 6), motion.unit_N)],
      ["period of stick-slip", period === null ? "none" : time(period, 6)],
      ...warned(motion),
    ]);
  }

  #draw() {
    if (!this.motion || this.phase.clientWidth === 0) return;
    const units = { a: this.motion.unit_a, u: this.motion.unit_x_dot };
    const { arrays } = this.motion;
    this.area = drawPhase(this.phase, arrays, this.start, this.scales, units);
    if (!this.dragging) this.#drawTime(this.motion);
  }

  #drawTime({ arrays: { t, x_dot: u, a, N: load }, ...units }) {
    const target = element("time");
    const every = Math.ceil(t.length / MOST_DRAWN);
    const thinned = (values) => values.filter((_, k) => k % every === 0 || k === values.length - 1);
    const data = [t, u, a, load].map(thinned);
    // As high as the phase plane beside it.
    const height = Math.max(130, this.phase.clientHeight);
    const size = { width: Math.max(200, target.clientWidth), height };
    const { colour, axis } = linesIn(target);
    const line = (label, name, scale) => ({
      label,
      scale,
      stroke: colour(name),
      width: 1.5,
    });
    const title = (symbol, unit) => titleOf({ symbol, unit });
    const both = `${title("a", units.unit_a)}, ${title("N", units.unit_N)}`;
    this.plot?.destroy();
    this.plot = new window.uPlot(
      {
        ...size,
        scales: { x: { time: false } },
        axes: [
          axis({ label: title("t", units.unit_t), size: 24, labelSize: 16 }),
          axis({ scale: "u", label: title("ẋ", units.unit_x_dot), size: 34, labelSize: 16 }),
          axis({ scale: "a", side: 1, label: both, size: 34, labelSize: 16, grid: { show: false } }),
        ],
        series: [
          { label: "t" },
          line("velocity ẋ", "calm", "u"),
          line("elongation a", "mark", "a"),
          line("load N", "third", "a"),
        ],
      },
      data,
      target,
    );
  }

  #listen() {
    const { phase } = this;
    const to = (start) => {
      this.start = start.map((x) => Number(x.toPrecision(5)));
      this.#draw();
      this.#ask();
    };
    const value = (event) => {
      const box = phase.getBoundingClientRect();
      const [x, y] = [event.clientX - box.left, event.clientY - box.top];
      const [a, u] = this.scales;
      return [
        u.value(1 - (y - this.area.y) / this.area.h),
        a.value((x - this.area.x) / this.area.w),
      ];
    };
    phase.addEventListener("pointerdown", (event) => {
      if (!this.motion || this.stored) return;
      phase.setPointerCapture(event.pointerId);
      this.dragging = true;
      to(value(event));
    });
    phase.addEventListener("pointermove", (event) => this.dragging && to(value(event)));
    const up = () => {
      if (!this.dragging) return;
      this.dragging = false;
      // The axes follow again.
      if (this.motion) this.#show(this.motion);
      this.moved(this.start);
    };
    for (const kind of ["pointerup", "pointercancel"]) phase.addEventListener(kind, up);
    phase.addEventListener("keydown", (event) => {
      const steps = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [1, 0], ArrowDown: [-1, 0] };
      const step = steps[event.key];
      if (!step || !this.motion || this.stored) return;
      event.preventDefault();
      const [a, u] = this.scales;
      const size = [0.02 * (u.to - u.from), 0.02 * (a.to - a.from)];
      to(this.start.map((x, i) => x + step[i] * size[i]));
      this.moved(this.start);
    });
    for (const [id, at] of [
      ["start-u", 0],
      ["start-a", 1],
    ]) {
      element(id).addEventListener("input", (event) => {
        const typed = event.target.valueAsNumber;
        if (!Number.isFinite(typed)) return;
        const start = [...this.start];
        start[at] = typed;
        to(start);
        this.moved(this.start);
      });
    }
  }
}
