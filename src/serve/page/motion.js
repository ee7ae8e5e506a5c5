// The motion from a start that can be dragged: in the phase plane and in time.

import { element, terms } from "./dom.js";
import { Newest } from "./newest.js";
import { drawPhase, linesIn, phaseScales } from "./plots.js";
import { told } from "./scale.js";

/** Points of a line that are drawn; more cannot be told apart. */
const MOST_DRAWN = 6000;
const REST = [0, 0];

export class MotionCard {
  /**
   * @param {object} source see source.js
   * @param {(start: number[]) => void} moved told where a start was dragged to
   * @param {(error: Error) => void} failed
   */
  constructor(source, moved, failed) {
    this.phase = element("phase");
    this.start = REST;
    this.text = null;
    this.moved = moved;
    const show = (motion) => this.#show(motion);
    this.requests = new Newest((text, signal) => source.motion(text, signal), show, failed);
    this.#listen();
    new ResizeObserver(() => this.#draw()).observe(this.phase);
  }

  /** Follows the motion of a case, without its start; none: there is no law. */
  look(text, start) {
    this.text = text;
    this.start = start ?? this.start;
    [this.motion, this.scales] = [null, null];
    element("motion").hidden = text === null;
    element("motion-none").hidden = text !== null;
    if (text !== null) this.#ask();
  }

  /** The case file of what is shown. */
  case() {
    const [u, a] = this.start;
    return `${this.text}\n[start]\nx_dot0 = ${u}\na0 = ${a}\n`;
  }

  #ask() {
    for (const [id, at] of [
      ["start-u", 0],
      ["start-a", 1],
    ]) {
      const input = element(id);
      if (document.activeElement !== input) input.value = this.start[at];
    }
    element("case").value = this.case();
    this.requests.want(this.case());
  }

  #show(motion) {
    this.motion = motion;
    this.scales = (this.dragging && this.scales) || phaseScales(motion.arrays, this.start);
    this.#draw();
    const { outcome, decided, settle_time: settle, n_min: load, period } = motion;
    terms(element("outcome"), [
      ["outcome", `${outcome}, known at t = ${told(decided, 5)}`],
      ["settles after", settle === null ? "never" : told(settle, 6)],
      ["smallest load", told(load, 6)],
      ["period of stick-slip", period === null ? "none" : told(period, 6)],
    ]);
  }

  #draw() {
    if (!this.motion || this.phase.clientWidth === 0) return;
    const units = { a: this.motion.unit_a, u: this.motion.unit_x_dot };
    const { arrays } = this.motion;
    this.area = drawPhase(this.phase, arrays, this.start, this.scales, units);
    if (!this.dragging) this.#drawTime(arrays);
  }

  #drawTime({ t, x_dot: u, a, N: load }) {
    const target = element("time");
    const every = Math.ceil(t.length / MOST_DRAWN);
    const thinned = (values) => values.filter((_, k) => k % every === 0 || k === values.length - 1);
    const data = [t, u, a, load].map(thinned);
    const size = { width: Math.max(200, target.clientWidth), height: 260 };
    const { colour, axis } = linesIn(target);
    const line = (label, name, scale) => ({
      label,
      scale,
      stroke: colour(name),
      width: 1.5,
    });
    this.plot?.destroy();
    this.plot = new window.uPlot(
      {
        ...size,
        scales: { x: { time: false } },
        axes: [
          axis({ label: "t" }),
          axis({ scale: "u", label: "ẋ" }),
          axis({ scale: "a", side: 1, label: "a, N", grid: { show: false } }),
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
      if (!this.motion) return;
      phase.setPointerCapture(event.pointerId);
      this.dragging = true;
      to(value(event));
    });
    phase.addEventListener("pointermove", (event) => this.dragging && to(value(event)));
    const up = () => {
      if (!this.dragging) return;
      this.dragging = false;
      this.moved(this.start);
      this.#ask();
    };
    for (const kind of ["pointerup", "pointercancel"]) phase.addEventListener(kind, up);
    phase.addEventListener("keydown", (event) => {
      const steps = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [1, 0], ArrowDown: [-1, 0] };
      const step = steps[event.key];
      if (!step || !this.motion) return;
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
