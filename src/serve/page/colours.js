// Colours of cells: the same as in pictures that slipmap draws, and told apart by the colour-blind.

import { told } from "./scale.js";

const STABLE = "#5fb9ae";
const NO_VALUE = "#b9b9b9";
/** Numbers of unstable roots, from 0 on; larger ones share the last colour. */
const COUNTS = [
  STABLE,
  "#d3c8f0",
  "#f6e8c3",
  "#a38fd6",
  "#dfc27d",
  "#7558b0",
  "#bf812d",
  "#40286e",
  "#7a4608",
];
const LAST_COUNT = COUNTS.length - 1;
/** What stands for no count, and for no small one. */
const [NO_COUNT, NO_FEW] = [65535, 255];
const counted = (n) => (n === 0 ? "stable" : `${n} unstable root${n === 1 ? "" : "s"}`);
const COUNT_NAMES = COUNTS.map((_, n) =>
  n === LAST_COUNT ? `${n} or more unstable roots` : counted(n),
);
/**
 * Fates of motions, ends of stick-slip, working velocities, by name. Those of one field are all told
 * apart, by the colour-blind too.
 */
const KINDS = {
  sliding: STABLE,
  "stick-slip": "#dfc27d",
  oscillation: "#9e5a12",
  "lift-off": "#2c4a7c",
  diverged: "#222222",
  undecided: NO_VALUE,
  "no-cycle": "#e8e8e8",
  grazing: "#009999",
  fold: "#dd9900",
  "period-doubling": "#bb7755",
  irregular: "#990000",
  persists: "#7733bb",
  never: "#007799",
  lost: "#bb77dd",
  stable: STABLE,
  bistable: "#c2e3f2",
  unstable: "#dfc27d",
};
const FEW = ["#c7eae5", "#35978f", "#dfc27d", "#7a4608"];
const VIRIDIS = [
  "#440154",
  "#472c7a",
  "#3b518b",
  "#2c718e",
  "#21908d",
  "#27ad81",
  "#5cc863",
  "#aadc32",
  "#fde725",
];
const BROWN_TEAL = [
  "#8c510a",
  "#bf812d",
  "#dfc27d",
  "#f6e8c3",
  "#f7f7f7",
  "#c7eae5",
  "#80cdc1",
  "#35978f",
  "#01665e",
];
/** How slipmap calls values that are the better the farther they lie below 0. */
const BELOW = new Set(["better-below", "relative-error"]);
/** And values over orders of magnitude. */
const LONG = new Set(["long-tail", "magnitudes", "decades", "relaxation"]);
/** Steps of a colour bar. */
const STEPS = 255;

const parts = (colour) => [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
const packed = ([r, g, b]) => ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;
const int = (colour) => packed(parts(colour));

/** The colour at a part of the way through a table, as red, green and blue. */
function sampled(table, part) {
  const at = Math.min(1, Math.max(0, part)) * (table.length - 1);
  const low = Math.min(table.length - 2, Math.floor(at));
  const [from, to] = [parts(table[low]), parts(table[low + 1])];
  return from.map((c, i) => Math.round(c + (at - low) * (to[i] - c)));
}

const css = ([r, g, b]) => `rgb(${r}, ${g}, ${b})`;

/** Colours of numbers that stand for a few things; all others are no values. */
class Classes {
  constructor(names, colours, classOf) {
    [this.names, this.colours, this.classOf] = [names, colours, classOf];
    this.ints = Uint32Array.from(colours, int);
    this.none = int(NO_VALUE);
    this.noValue = NO_VALUE;
  }

  pixel(value) {
    return this.ints[this.classOf(value)] ?? this.none;
  }

  /** The name of a value: of its class, where it has none of its own. */
  name(value) {
    const name = this.names[this.classOf(value)];
    return name === undefined ? "no value" : (this.own?.(value) ?? name);
  }

  /** What the colours mean: {colour, text} each. */
  get legend() {
    return this.names.map((text, i) => ({ colour: this.colours[i], text }));
  }
}

/** Colours along a bar. `part` says where on it a value lies, 0 to 1; `value` what lies there. */
class Bar {
  constructor(table, part, value, words) {
    Object.assign(this, { part, value, words });
    this.table = table;
    this.ints = Uint32Array.from({ length: STEPS + 1 }, (_, i) =>
      packed(sampled(table, i / STEPS)),
    );
    this.none = int(NO_VALUE);
  }

  pixel(value) {
    const part = this.part(value);
    if (Number.isNaN(part)) return this.none;
    return this.ints[Math.round(Math.min(1, Math.max(0, part)) * STEPS)];
  }

  name(value) {
    return told(value);
  }

  get legend() {
    const stops = Array.from({ length: 9 }, (_, i) => css(sampled(this.table, i / 8)));
    const ticks = [0, 0.25, 0.5, 0.75, 1].map((part) => told(this.value(part), 3));
    return { stops, ticks, words: this.words, none: NO_VALUE };
  }
}

/** The smallest and largest finite value of those that `counts`. */
function extent(values, counts = () => true) {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    if (!Number.isFinite(value) || !counts(value)) continue;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return low <= high ? [low, high] : [0, 1];
}

function linear(values) {
  let [low, high] = extent(values);
  if (low === high) [low, high] = [low - 0.5, high + 0.5];
  if (low > 0 && low < 0.5 * high) low = 0;
  const words = ["low", "high"];
  return new Bar(
    VIRIDIS,
    (v) => (v - low) / (high - low),
    (p) => low + p * (high - low),
    words,
  );
}

/** Over orders of magnitude; what is not above 0 has the lowest colour. */
function logarithmic(values) {
  const [low, high] = extent(values, (v) => v > 0);
  const [a, b] = [Math.log(Math.max(low, high * 1e-6)), Math.log(high)];
  if (!(b > a)) return linear(values);
  const part = (v) => (Number.isNaN(v) ? NaN : v > 0 ? (Math.log(v) - a) / (b - a) : 0);
  return new Bar(VIRIDIS, part, (p) => Math.exp(a + p * (b - a)), ["small", "large"]);
}

/** About a change of stability at 0: brown on the unstable side. */
function aboutZero(values, stable, words) {
  const [low, high] = extent(values);
  const size = Math.max(Math.abs(low), Math.abs(high)) || 1;
  const root = (p) => Math.sign(p) * Math.sqrt(Math.abs(p));
  const part = (v) => (Number.isNaN(v) ? NaN : 0.5 + 0.5 * root((stable * v) / size));
  const value = (p) => stable * size * Math.sign(p - 0.5) * (2 * p - 1) ** 2;
  return new Bar(BROWN_TEAL, part, value, words);
}

/**
 * The colours of a field's cells.
 * @param {{name: string, kinds?: string[], spread?: string, stable_sign?: number}} field
 * @param {ArrayLike<number>} values those that are to be seen
 */
export function coloursOf(field, values) {
  if (field.name === "n_unstable") {
    const classOf = (n) => (n === NO_COUNT ? NaN : Math.min(LAST_COUNT, n));
    return Object.assign(new Classes(COUNT_NAMES, COUNTS, classOf), { own: counted });
  }
  if (field.kinds) {
    const colours = field.kinds.map((kind, i) => KINDS[kind] ?? FEW[i % FEW.length]);
    return new Classes(field.kinds, colours, (n) => n);
  }
  const spread = field.spread ?? "";
  if (spread === "about-zero") {
    const words =
      field.unit && /^abscissa/.test(field.name) ? ["grows", "decays"] : ["unstable", "stable"];
    return aboutZero(values, field.stable_sign ?? 1, words);
  }
  if (BELOW.has(spread)) return aboutZero(values, -1, ["above 0", "below 0"]);
  if (LONG.has(spread)) return logarithmic(values);
  const bar = linear(values);
  const { part } = bar;
  if (field.storage === "few") bar.part = (v) => (v === NO_FEW ? NaN : part(v));
  return bar;
}
