// Everything about one point, by its exact values.

import { Asked } from "./asked.js";
import { copy, element, make, terms, warned } from "./dom.js";
import { MotionCard } from "./motion.js";
import { drawDelays, drawRoots } from "./plots.js";
import { told, unitOf, withUnit } from "./scale.js";
import { aboutSystem } from "./system.js";
import { Waiting } from "./waiting.js";

/** Intervals and roots that are told in words. */
const [INTERVALS, ROOTS] = [8, 8];
/** How long what is slower than the point is waited for, in milliseconds: so nothing flickers. */
const PATIENCE = 250;

const ENDS = {
  grazing: "the slip grazes the sticking velocity",
  fold: "a fold: the cycle of stick-slip meets an unstable one",
  "lift-off": "the load reaches 0 first",
  persists: "it survives at every velocity that is tried",
  never: "stick-slip is never sustained",
};
const NO_COMMAND = "There is no command line for a table; see the TOML.";
const NO_V0 = "This map gives no v0: there is no sliding to look at, only the critical velocity.";
const FORMER = "What is shown here is of the point before; that of this one is not there yet.";
const NO_POINT = "This map is not about single points of the model.";

/** Where `v0` lies, by the bounds of a critical velocity. */
function placed(v0, found) {
  if (found.vc_lower !== null && v0 <= found.vc_lower) return " (v0 lies below it)";
  if (found.vc_upper !== null && v0 > found.vc_upper) return " (v0 lies above it)";
  return found.vc === null ? "" : " (where v0 lies is not known)";
}

/** The units that a text is written in, as "force,length,time"; none of a dimensionless one. */
function unitsOf(text) {
  const names = ["force", "length", "time"].map(
    (key) => text?.match(new RegExp(`^${key} = "([^"]*)"`, "m"))?.[1],
  );
  return names.every(Boolean) ? names.join(",") : "";
}

/** A number of unstable roots in words. */
export const counted = (n) =>
  n === null ? "not counted" : `${n} unstable root${n === 1 ? "" : "s"}`;

export class Panel {
  /**
   * @param {object} source see source.js
   * @param {{moved: (start: number[]) => void, told: () => void, words: (error: Error) => string,
   *   lost: (error: Error) => boolean}} told of: a start that was moved, a point that is shown, an
   *   error's words, whether the server is gone
   */
  constructor(source, { moved, told: shown, words, lost }) {
    Object.assign(this, { shown, words });
    const heard = (asked) => {
      asked.lost = Boolean(asked.error) && lost(asked.error);
      const { error, lost: gone } = asked;
      if (error && !gone && !error.status && !error.stopped) console.error(error);
      this.#tell();
    };
    this.points = new Asked((text, signal) => source.point(text, signal), heard);
    this.velocities = new Asked((text, signal) => source.vc(text, signal), heard);
    this.motion = new MotionCard(source, { moved, heard, words });
    const slow = (id, what, asked) => {
      const again = () => {
        asked.again();
        this.#tell();
      };
      return new Waiting(element(id), what, { stop: () => asked.stop(), again });
    };
    this.waiting = {
      point: slow("point-waiting", "The point", this.points),
      vc: slow("vc-waiting", "The critical velocity", this.velocities),
      motion: slow("motion-waiting", "The motion", this.motion),
    };
    for (const field of ["command", "vc-command", "toml", "vc-toml", "case"]) {
      const click = (event) => copy(element(field).value, event.target);
      element(`copy-${field}`).addEventListener("click", click);
    }
    const redraw = () => this.#draw();
    for (const id of ["roots", "delays"]) new ResizeObserver(redraw).observe(element(id));
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  }

  /**
   * Asks for everything at a point. Until that is there, what is shown stays, with its heading.
   * @param {{point: string | null, vc: string | null, motion: string | null, v0?: number}} texts
   * @param {{where: string, start: number[] | null, fixed?: boolean, title?: string,
   *   at?: number[], stored?: object}} about fixed: no other friction law can be chosen; title:
   *   whose answers these are; at: the point; stored: the motion, which is that of a trace
   */
  look(texts, about) {
    this.next = { texts, ...about, problem: null };
    this.points.want(texts.point);
    this.velocities.want(texts.vc);
    this.motion.look(texts.motion, about.start, about.stored);
    clearTimeout(this.patience);
    this.patience = setTimeout(() => {
      this.patience = null;
      this.#tell();
    }, PATIENCE);
    this.#tell();
  }

  /** Shows that nothing can be asked at a point, and why. */
  refuse(error, about) {
    this.look({ point: null, vc: null, motion: null }, about);
    this.next.problem = error;
    this.#tell();
  }

  /** Shows no point until the next one. */
  clear() {
    this.look({ point: null, vc: null, motion: null }, { where: "", start: null });
    clearTimeout(this.patience);
    [this.patience, this.next] = [null, null];
    element("point-none").hidden = true;
  }

  /** The answer about a text, if it is the one that is shown. */
  answerTo(text) {
    return this.point && this.text === text ? this.point : null;
  }

  /** Whether something is asked for. */
  get pending() {
    return this.points.pending || this.velocities.pending || this.motion.pending;
  }

  #tell() {
    if (!this.next) return;
    const { points, velocities, motion, next } = this;
    const slow = this.patience && (velocities.pending || motion.pending);
    const waits = points.pending || points.lost || (slow && !points.error);
    this.#tellWaiting();
    const section = element("point-title").closest("section");
    section.classList.toggle("asking", Boolean(waits));
    section.setAttribute("aria-busy", String(Boolean(waits)));
    const former = waits && !this.patience && !element("cards").hidden;
    element("point-stale").textContent = former ? FORMER : "";
    if (waits) return;
    const { texts, where, fixed = false, title = "At the point", stored = null } = next;
    element("point-title").textContent = stored ? "The trace" : title;
    element("point-origin").textContent = stored ? "from the file" : "computed now";
    this.at = next.at ?? null;
    const problem = next.problem ?? points.error;
    element("point-where").textContent = where;
    element("point-problem").textContent = problem ? this.words(problem) : "";
    element("point-none").textContent = texts.vc === null ? NO_POINT : NO_V0;
    element("point-none").hidden = Boolean(problem ?? stored) || texts.point !== null;
    element("cards").hidden = Boolean(problem) || Object.values(texts).every((t) => t === null);
    this.units = unitsOf(texts.point ?? texts.vc);
    this.#tellPoint(points.answer);
    this.#tellVc(texts, fixed);
    element("motion-card").hidden = texts.motion === null && (fixed || texts.point === null);
    motion.tell();
    this.#tellSame(texts);
    this.shown();
  }

  /** What takes long says so, and can be stopped. */
  #tellWaiting() {
    const { points, velocities, motion, waiting } = this;
    for (const [which, asked, key] of [
      ["point", points, points.text],
      ["vc", velocities, velocities.text],
      ["motion", motion, motion.text && motion.case()],
    ]) {
      if (asked.pending && !asked.lost) waiting[which].goesOn(key);
      else waiting[which].ends(key);
    }
  }

  /** A quantity in words, by its powers of force, length and time. */
  #quantity(value, dimension) {
    if (value === null) return "no value";
    return withUnit(told(value), unitOf(dimension, this.units));
  }

  #time(value) {
    return this.#quantity(value, [0, 0, 1]);
  }

  /** Stable intervals of the quantity with this symbol, in words. */
  #intervals(symbol, found, truncated) {
    if (!found) return "unknown";
    const end = (to) => (to === null ? "∞" : this.#time(to));
    const stable = found.slice(0, INTERVALS);
    const words = stable.map(([from, to]) => `${told(from)} < ${symbol} < ${end(to)}`);
    const more = found.length - stable.length;
    if (more > 0) words.push(`${more}${truncated ? " or more" : ""} others`);
    return words.join(", ") || "none";
  }

  #tellPoint(point) {
    for (const card of ["sliding", "roots", "delays"]) element(`${card}-card`).hidden = !point;
    const before = this.point;
    [this.point, this.text] = [point, this.points.text];
    if (!point || point === before) return;
    const { delay_margin_kind: kind } = point;
    const margin = kind === "finite" ? this.#time(point.delay_margin) : kind;
    const verdict = point.marginal ? "marginal" : point.stable ? "stable" : "unstable";
    const delays = this.#intervals("τ", point.stable_delays, point.stable_delays_truncated);
    const latencies = this.#intervals(
      "δ",
      point.stable_latencies,
      point.stable_latencies_truncated,
    );
    const rate = unitOf([0, 0, -1], this.units);
    const root = ([re, im]) => withUnit(told(re) + (im === 0 ? "" : ` ± ${told(im)} i`), rate);
    const sure = point.certified ? "certified" : "not certified";
    const abscissa = point.abscissa === null ? "unknown" : withUnit(told(point.abscissa), rate);
    const ofSystem = aboutSystem(point, (value) => this.#time(value));
    element("sliding-title").textContent = ofSystem ? "System" : "Sliding";
    terms(element("point"), [
      [ofSystem ? "it is" : "sliding is", `${verdict}, ${counted(point.n_unstable)}`],
      ...(ofSystem ?? [["slope μ′", this.#quantity(point.mu_prime, [0, -1, 1])]]),
      ["delay margin", margin],
      ["spectral abscissa", abscissa],
      ["rightmost roots", sure],
      ...warned(point),
    ]);
    const late = ofSystem && point.latency !== null;
    const ofLatency = late ? [["stable latencies", latencies]] : [];
    terms(element("intervals"), [["stable delays", delays], ...ofLatency]);
    const list = point.roots.slice(0, ROOTS).map((r) => make("li", {}, root(r)));
    element("root-list").replaceChildren(...list);
    this.#draw();
  }

  #draw() {
    if (!this.point || element("roots").clientWidth === 0) return;
    const rate = unitOf([0, 0, -1], this.units);
    drawRoots(element("roots"), { ...this.point, unit: rate });
    drawDelays(element("delays"), this.point, { unit: unitOf([0, 0, 1], this.units) });
  }

  #tellVc({ vc, v0 }, fixed) {
    element("vc-card").hidden = vc === null && fixed;
    element("vc-none").hidden = vc !== null;
    element("vc").hidden = vc === null;
    const { answer: found, error } = this.velocities;
    const one = (words) => terms(element("vc"), [["critical velocity", words]]);
    if (error && !this.velocities.lost) one(this.words(error));
    else if (!found) one("…");
    if (!found) return;
    const velocity = (v) => this.#quantity(v, [0, 1, -1]);
    const bound = (v) => (v === null ? "no velocity seen" : velocity(v));
    const verdict = v0 === undefined ? "" : placed(v0, found);
    const [stuck, slipping] = [found.stick_time, found.slip_time].map((t) => this.#time(t));
    terms(element("vc"), [
      ["critical velocity", (found.vc === null ? "none" : velocity(found.vc)) + verdict],
      ...(found.decided
        ? []
        : [["between", `${bound(found.vc_lower)} and ${bound(found.vc_upper)}`]]),
      [
        "stick-slip ends by",
        `${found.outcome}${ENDS[found.outcome] ? `: ${ENDS[found.outcome]}` : ""}`,
      ],
      ["in a period there", `stuck ${stuck}, slipping ${slipping}`],
      ["load reaches 0 from", found.v_liftoff === null ? "no velocity" : velocity(found.v_liftoff)],
      ["asked by the protocol", found.protocol],
      ["found by", `${found.method}${found.decided ? "" : "; not decided beyond"}`],
      ...warned(found),
    ]);
  }

  /** What to type and to save for the same. There is no button without something to copy. */
  #tellSame(texts) {
    const commands = [
      ["command", texts.point, this.point],
      ["vc-command", texts.vc, this.velocities.answer],
    ];
    for (const [id, text, answer] of commands) {
      const command = (text !== null && answer?.command) || "";
      element(`same-${id}`).hidden = text === null || !answer;
      element(id).placeholder = command ? "" : NO_COMMAND;
      element(id).value = command;
      element(`copy-${id}`).disabled = !command;
    }
    for (const [id, text] of [
      ["toml", texts.point],
      ["vc-toml", texts.vc],
      ["case", texts.motion && this.motion.case()],
    ]) {
      element(`same-${id}`).hidden = text === null;
      element(id).value = text ?? "";
    }
  }
}
