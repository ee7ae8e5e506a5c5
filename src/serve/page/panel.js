// Everything about one point, by its exact values.

import { copy, element, make, terms } from "./dom.js";
import { MotionCard } from "./motion.js";
import { Newest } from "./newest.js";
import { drawDelays, drawRoots } from "./plots.js";
import { told } from "./scale.js";

/** Intervals and roots that are told in words. */
const [INTERVALS, ROOTS] = [8, 8];

const ENDS = {
  grazing: "the slip grazes the sticking velocity",
  fold: "a fold: the cycle of stick-slip meets an unstable one",
  "lift-off": "the load reaches 0 first",
  persists: "it survives at every velocity that is tried",
  never: "stick-slip is never sustained",
};

export class Panel {
  /**
   * @param {object} source see source.js
   * @param {{moved: (start: number[]) => void, failed: (error: Error) => void}} told
   */
  constructor(source, { moved, failed }) {
    const ask = (kind) => (text, signal) => source[kind](text, signal);
    this.points = new Newest(ask("point"), (answer) => this.#showPoint(answer), failed);
    this.velocities = new Newest(
      ask("vc"),
      (found) => this.#showVc(found),
      (error) => {
        terms(element("vc"), [["critical velocity", error.message]]);
      },
    );
    this.motion = new MotionCard(source, moved, failed);
    for (const [button, field] of [
      ["copy-command", "command"],
      ["copy-toml", "toml"],
      ["copy-case", "case"],
    ]) {
      element(button).addEventListener("click", (event) => copy(element(field), event.target));
    }
    const redraw = () => this.#draw();
    for (const id of ["roots", "delays"]) new ResizeObserver(redraw).observe(element(id));
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  }

  /**
   * Asks for everything at a point.
   * @param {{point: string | null, vc: string | null, motion: string | null, v0?: number}} texts
   * @param {{where: string, start: number[] | null, unit: string, fixed?: boolean}} about fixed: no
   *   other friction law can be chosen
   */
  look(texts, { where, start, unit = "1", fixed = false }) {
    element("point-where").textContent = where;
    element("toml").value = texts.point ?? "";
    element("point-none").hidden = texts.point !== null;
    this.unit = unit;
    this.v0 = texts.v0;
    if (texts.point !== null) this.points.want(texts.point);
    element("take-law").hidden = fixed;
    const law = fixed ? "The map has none." : "Choose one first.";
    element("vc-none").textContent = `It depends on the whole friction law. ${law}`;
    element("vc-none").hidden = texts.vc !== null;
    element("vc").hidden = texts.vc === null;
    if (texts.vc !== null) {
      terms(element("vc"), [["critical velocity", "…"]]);
      this.velocities.want(texts.vc);
    }
    this.motion.look(texts.motion, start);
  }

  #showPoint(point) {
    this.point = point;
    this.#draw();
    const margin = point.delay_margin === null ? "infinite" : told(point.delay_margin);
    const verdict = point.marginal ? "marginal" : point.stable ? "stable" : "unstable";
    const interval = ([from, to]) => `${told(from)} < τ < ${to === null ? "∞" : told(to)}`;
    const stable = point.stable_delays.slice(0, INTERVALS).map(interval);
    const more = point.stable_delays.length - stable.length;
    if (more > 0) stable.push(`${more}${point.stable_delays_truncated ? " or more" : ""} others`);
    const root = ([re, im]) => told(re) + (im === 0 ? "" : ` ± ${told(im)} i`);
    const count = `${point.n_unstable} unstable root${point.n_unstable === 1 ? "" : "s"}`;
    const sure = point.certified ? "confirmed by the argument principle" : "not certified";
    terms(element("point"), [
      ["sliding is", `${verdict}, ${count}`],
      ["slope μ′", told(point.mu_prime)],
      ["delay margin", margin],
      ["spectral abscissa", point.abscissa === null ? "unknown" : told(point.abscissa)],
      ["rightmost roots", sure],
    ]);
    const delays = stable.length ? stable.join(", ") : "none";
    terms(element("intervals"), [["stable delays", delays]]);
    const list = point.roots.slice(0, ROOTS).map((r) => make("li", {}, root(r)));
    element("root-list").replaceChildren(...list);
    element("command").value =
      point.command ?? "there is no command line for a table; see the TOML";
  }

  #draw() {
    if (!this.point || element("roots").clientWidth === 0) return;
    const rate = this.unit === "1" ? "1" : `1/${this.unit}`;
    drawRoots(element("roots"), { ...this.point, unit: rate });
    drawDelays(element("delays"), this.point, { unit: this.unit });
  }

  #showVc(found) {
    const here = this.v0;
    const below = found.vc !== null && here !== undefined;
    const verdict = below ? (here < found.vc ? " (v0 lies below it)" : " (v0 lies above it)") : "";
    terms(element("vc"), [
      ["critical velocity", found.vc === null ? "none" : told(found.vc) + verdict],
      [
        "stick-slip ends by",
        `${found.outcome}${ENDS[found.outcome] ? `: ${ENDS[found.outcome]}` : ""}`,
      ],
      ["in a period there", `stuck ${told(found.stick_time)}, slipping ${told(found.slip_time)}`],
      ["load reaches 0 from", found.v_liftoff === null ? "no velocity" : told(found.v_liftoff)],
      ["asked by the protocol", found.protocol],
      ["found by", `${found.method}${found.decided ? "" : "; not decided beyond"}`],
    ]);
  }
}
