// Scales of axes: from values to parts of the way between two ends, and back.

/** A linear or logarithmic scale. The ends of a logarithmic one have the same sign. */
export class Scale {
  /**
   * @param {number} from
   * @param {number} to
   * @param {boolean} log
   */
  constructor(from, to, log = false) {
    this.from = from;
    this.to = to;
    this.log = log && from * to > 0;
    this.sign = from < 0 ? -1 : 1;
    [this.a, this.b] = [this.#linear(from), this.#linear(to)];
  }

  #linear(value) {
    return this.log ? Math.log(this.sign * value) : value;
  }

  /** Where a value lies: 0 at the one end, 1 at the other. */
  part(value) {
    return (this.#linear(value) - this.a) / (this.b - this.a);
  }

  /** The value at a part of the way. */
  value(part) {
    const at = this.a + part * (this.b - this.a);
    return this.log ? this.sign * Math.exp(at) : at;
  }

  /** The part of the scale between two parts of the way. */
  between(from, to) {
    return new Scale(this.value(from), this.value(to), this.log);
  }

  /** Round values on it, at most about `most`. */
  ticks(most) {
    return this.log ? this.#decades(most) : evenTicks(this.from, this.to, most);
  }

  #decades(most) {
    const [low, high] = [this.sign * this.from, this.sign * this.to].sort((p, q) => p - q);
    const list = [];
    for (let power = Math.floor(Math.log10(low)); 10 ** power <= high; power++) {
      for (const n of [1, 2, 5]) list.push(n * 10 ** power);
    }
    const inside = list.filter((x) => x >= low * (1 - 1e-12) && x <= high * (1 + 1e-12));
    if (inside.length < 2) return evenTicks(this.from, this.to, most);
    const powers = inside.filter((x) => /^1e/.test(x.toExponential()));
    const kept = inside.length > most && powers.length > 1 ? powers : inside;
    const every = Math.ceil(kept.length / Math.max(1, most));
    return kept.filter((_, i) => i % every === 0).map((x) => this.sign * x);
  }
}

/** What is nearer to 0 than this has no place on a logarithmic axis: slipmap takes no less. */
const NEAREST = 1e-12;

/** The scale moved to where both ends lie within a range; cut where the range is not as long. */
export function movedInto(scale, [low, high]) {
  const { log, sign } = scale;
  const ends = !log ? [low, high] : sign > 0 ? [Math.max(low, NEAREST), high] : [low, -NEAREST];
  const [first, last] = [scale.part(ends[0]), scale.part(ends[1])];
  if (last - first <= 1) return new Scale(...ends, log);
  const by = Math.max(0, first) || Math.min(0, last - 1);
  const within = (value) => Math.min(ends[1], Math.max(ends[0], value));
  return by === 0
    ? scale
    : new Scale(...[by, 1 + by].map((part) => within(scale.value(part))), log);
}

/** The ends of a scale with no more digits than the eye tells apart. */
export function roundEnds({ from, to, log }) {
  const size = log ? Math.abs(Math.log(to / from)) : to - from;
  const finer = 4 - Math.floor(Math.log10(size));
  // On a logarithmic scale a step is a part of the value itself.
  if (log) return [from, to].map((x) => Number(x.toPrecision(Math.min(15, Math.max(5, finer)))));
  const step = 10 ** -finer;
  return [from, to].map((x) => Number((Math.round(x / step) * step).toPrecision(12)));
}

/** Round numbers between two, at most about `most` of them. */
function evenTicks(from, to, most) {
  const [low, high] = from < to ? [from, to] : [to, from];
  const rough = (high - low) / Math.max(1, most);
  if (!(rough > 0) || !Number.isFinite(rough)) return [low];
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((n) => n * power).find((s) => s >= rough * (1 - 1e-9));
  const list = [];
  const first = Math.ceil(low / step - 1e-9);
  for (let n = first; n * step <= high + 1e-9 * step && list.length < 100; n++) list.push(n * step);
  return list;
}

/** A number as people read it; not longer than it needs to be. */
export function told(x, digits = 6) {
  if (x === null || x === undefined || Number.isNaN(x)) return "no value";
  if (!Number.isFinite(x)) return x > 0 ? "∞" : "−∞";
  if (x === 0) return "0";
  return Number(x.toPrecision(digits)).toString().replaceAll("-", "−");
}

/** An axis this much narrower than its numbers has ticks that tell how far they are from one. */
const NARROW = 1e-3;

/**
 * Ticks of an axis that can be told apart, with their labels. Where these would be long, they tell
 * the difference to `origin`, which is 0 otherwise.
 * @param {Scale} scale
 * @param {number} most
 */
export function ticksOf(scale, most) {
  const [span, size] = [
    Math.abs(scale.to - scale.from),
    Math.max(Math.abs(scale.from), Math.abs(scale.to)),
  ];
  let origin = 0;
  if (span < NARROW * size) {
    const power = Math.ceil(Math.log10(span));
    // Through text: a product of powers of ten would not be round.
    origin = Number(`${Math.round(((scale.from + scale.to) / 2) * 10 ** -power)}e${power}`);
  }
  // Steps leave digits behind that mean nothing.
  const label = (x) => told(Math.abs(x) < 1e-6 * span ? 0 : x);
  const list = scale.ticks(Math.max(2, most));
  return { origin, ticks: list.map((x) => ({ part: scale.part(x), text: label(x - origin) })) };
}

/** The unit of a quantity by its powers of force, length and time, as slipmap writes it. */
export function unitOf(dimension, units) {
  if (!units) return "1";
  const names = units.split(",").map((name, i) => [name, dimension[i]]);
  const factors = names.filter(([, power]) => power !== 0);
  return factors.map(([name, power]) => (power === 1 ? name : name + power)).join(" ") || "1";
}

/** A number in words with its unit. */
export const withUnit = (text, unit) => (!unit || unit === "1" ? text : `${text} ${unit}`);

/** A value along an axis in words; of a delay that is a period with its speed. */
export function valueAlong({ symbol, unit, speed }, value, digits) {
  const words = withUnit(`${symbol} = ${told(value, digits)}`, unit);
  if (!speed || !(value > 0)) return words;
  return `${words} (${speed.name} ${told(speed.turn / value, digits)} ${speed.unit})`;
}

/** A phrase at the beginning of a line. Symbols stay as they are. */
export const begun = (words) =>
  /^\p{Ll}+( |$)/u.test(words) ? words[0].toUpperCase() + words.slice(1) : words;
