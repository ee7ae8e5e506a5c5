// Colours of cells. What they mean is told by slipmap with every field and every answer, so that
// pictures show the same; here they become pixels.

import { told, withUnit } from "./scale.js";

/** A colour as red, green and blue. */
export const parts = (colour) => [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
const packed = ([r, g, b]) => ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;
/** A colour as a pixel of an image. */
export const int = (colour) => packed(parts(colour));

/** What is said of a number of unstable roots. */
const counted = (n, words) =>
  n === 0 ? "stable" : `${words} unstable root${n === 1 ? "" : "s"}`;

/** Colours of numbers that stand for a few things; those beyond the last one share its colour. */
class Classes {
  constructor({ name, kinds, classes, largest }, { none }) {
    [this.kinds, this.largest] = [kinds, largest];
    this.counts = name === "n_unstable";
    this.texts = classes.map(({ text }) => text);
    this.ints = Uint32Array.from(classes, ({ colour }) => int(colour));
    this.none = int(none);
  }

  /** The place of a value among the classes. */
  classOf(value) {
    return value >= this.ints.length && !this.kinds ? this.ints.length - 1 : value;
  }

  pixel(value) {
    return this.ints[this.classOf(value)] ?? this.none;
  }

  /** A value in words: of kinds as in the file. */
  name(value) {
    if (Number.isNaN(value)) return told(value);
    if (this.kinds) return this.kinds[value] ?? told(NaN);
    const words = value === this.largest ? `${value} or more` : told(value);
    return this.counts ? counted(value, words) : words;
  }
}

/** Colours of numbers on a scale. */
class Steps {
  constructor({ scale, none, entries }) {
    this.ends = Float64Array.from(scale.ends);
    this.ints = Uint32Array.from(scale.colours, int);
    [this.zero, this.infinite, this.minusInfinite] = [
      scale.zero,
      scale.infinite,
      scale.minus_infinite,
    ].map((colour) => colour && int(colour));
    this.none = int(none);
    // What some values mean is said in the legend.
    this.special = new Map(entries.map(({ colour, text }) => [colour && int(colour), text]));
    // The stretch of the last value: neighbours mostly lie on the same.
    [this.low, this.high, this.last] = [NaN, NaN, this.none];
  }

  pixel(value) {
    if (value >= this.low && value < this.high && value !== 0) return this.last;
    if (Number.isNaN(value)) return this.none;
    if (value === 0 && this.zero !== null) return this.zero;
    if (value === Infinity) return this.infinite;
    if (value === -Infinity) return this.minusInfinite;
    const { ends } = this;
    let [from, to] = [0, ends.length];
    while (from < to) {
      const middle = (from + to) >> 1;
      if (ends[middle] <= value) from = middle + 1;
      else to = middle;
    }
    this.low = from > 0 ? ends[from - 1] : -Infinity;
    this.high = from < ends.length ? ends[from] : Infinity;
    this.last = this.ints[from];
    return this.last;
  }

  /** A value in words, with its unit; what 0 and infinity mean. */
  name(value, unit) {
    const apart = (value === 0 && this.zero !== null) || Math.abs(value) === Infinity;
    return (apart && this.special.get(this.pixel(value))) || withUnit(told(value), unit);
  }
}

/**
 * The colours of a field's cells.
 * @param {{name: string, kinds?: string[], classes?: {text: string, colour: string}[]}} field
 * @param {{scale: object | null, none: string, entries: object[]}} shown what an answer says of them
 */
export const coloursOf = (field, shown) =>
  shown.scale ? new Steps(shown) : new Classes(field, shown);
