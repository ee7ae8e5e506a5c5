// Cells of a plane: what they hold, in words, and as an image.

import { int } from "./colours.js";
import { told } from "./scale.js";

/** Bits that a window of a map has for each of its pixels. */
const SEVERAL = 1;
const UNREAD = 2;
const BEYOND = 8;
/** What stands for no value, by how a field is stored; NaN for real numbers. */
const FILLS = { count: 65535, kind: 255, few: 255 };

const INK = 0xff1b1b1b;
const LIGHT = 0xfff2f2f2;
const MIDDLE = 0xffd0d0d0;
/** How far apart the lines over cells are that show no value, in pixels. */
export const SPACING = 6;

/** Whether a pixel lies beyond the map. */
export const isBeyond = ({ bits }, n) => Boolean(bits?.[n] & BEYOND);

/** Why the cell of a pixel shows no value, as slipmap tells it; none where it does. */
export function gapOf({ gaps, shown }, n) {
  const number = gaps?.[n];
  return number ? shown.fills.find(({ gap }) => gap === number) : undefined;
}

/** Why nothing is known of the cell of a pixel, in words; none where something is. */
export function lacking(plane, n) {
  const { bits, damage, rests } = plane;
  if (bits?.[n] & BEYOND) return "beyond the map";
  if (bits?.[n] & UNREAD) return damage && rests ? "could not be read" : "not read yet";
  const gap = gapOf(plane, n);
  return gap?.name === "not-computed" ? gap.text : null;
}

/** The number that the cell of a pixel has; NaN where there is none. */
export function valueOf(plane, n) {
  const value = plane.cells[n];
  return lacking(plane, n) || value === FILLS[plane.field.storage] ? NaN : value;
}

/** A value of a field as people read it: kinds by their names. */
export function tellNumber({ kinds }, value) {
  return kinds ? (kinds[value] ?? told(NaN)) : told(value);
}

/** What the cell of a pixel shows, in words: its value, or why there is none. */
export function wordsOf(plane, n) {
  return lacking(plane, n) ?? gapOf(plane, n)?.text ?? plane.colours.name(valueOf(plane, n));
}

/** What else a pixel says besides its value, `flags` being those that a status can have. */
export function flagsOf(plane, flags, n) {
  if (lacking(plane, n)) return [];
  const list = flags.filter(({ mask }) => plane.status?.[n] & mask).map(({ text }) => text);
  if (plane.bits?.[n] & SEVERAL) list.unshift("other values are hidden here: zoom in");
  return list;
}

/** Where lines over cells run, x to the right and y upwards. */
const LINES = {
  rising: (i, j) => i - j,
  falling: (i, j) => i + j,
  upright: (i) => i,
  level: (_, j) => j,
};

/** The pixels of a fill, which repeat after so many: x to the right, then y upwards. */
export function tileOf({ ground, lines }, hatch) {
  const tile = new Uint32Array(SPACING * SPACING).fill(int(ground));
  for (let i = 0, n = 0; i < SPACING; i++) {
    for (let j = 0; j < SPACING; j++, n++) {
      if (lines.some((line) => LINES[line](i, j) % SPACING === 0)) tile[n] = int(hatch);
    }
  }
  return tile;
}

/** The colours of all cells. A row of the image is a column of cells, as they stand in memory. */
function coloured({ nx, ny, cells, colours }) {
  const pixels = new Uint32Array(nx * ny);
  let [last, colour] = [NaN, colours.none];
  for (let n = 0; n < pixels.length; n++) {
    const value = cells[n];
    if (value !== last) [last, colour] = [value, colours.pixel(value)];
    pixels[n] = colour;
  }
  return pixels;
}

/** Fills cells without a value, and puts dots where several values are hidden. */
function mark(pixels, { nx, ny, gaps, bits, shown }) {
  const tiles = [];
  for (const fill of shown.fills) tiles[fill.gap] = tileOf(fill, shown.hatch);
  for (let i = 0, n = 0; i < nx; i++) {
    for (let j = 0; j < ny; j++, n++) {
      const bit = bits ? bits[n] : 0;
      const gap = gaps ? gaps[n] : 0;
      if (bit & BEYOND) pixels[n] = 0;
      else if (bit & UNREAD) pixels[n] = (i + j) % 8 < 4 ? LIGHT : MIDDLE;
      else if (gap) pixels[n] = tiles[gap][(i % SPACING) * SPACING + (j % SPACING)];
      else if (bit & SEVERAL && (i + j) & 1) pixels[n] = INK;
    }
  }
}

/**
 * Paints the cells of a plane into a canvas of as many pixels, x downwards and y to the right.
 * @param {HTMLCanvasElement} canvas
 * @param {{nx: number, ny: number, cells: ArrayLike<number>, colours: object, shown: object,
 *   gaps?: Uint8Array, bits?: Uint8Array}} plane cells by x, then y
 * @returns {{mark: string, text: string}[]} what the marks mean that are in it, besides its fills
 */
export function paint(canvas, plane) {
  const { nx, ny, bits } = plane;
  if (canvas.width !== ny || canvas.height !== nx) [canvas.width, canvas.height] = [ny, nx];
  const pixels = coloured(plane);
  let all = 0;
  if (bits) for (let n = 0; n < bits.length; n++) all |= bits[n];
  if (all || plane.shown.fills.length > 0) mark(pixels, plane);
  const image = new ImageData(new Uint8ClampedArray(pixels.buffer), ny, nx);
  canvas.getContext("2d").putImageData(image, 0, 0);
  const list = [];
  if (all & SEVERAL) list.push({ mark: "dotted", text: "hides several values: zoom in" });
  if (all & UNREAD)
    list.push({
      mark: "striped",
      text: plane.damage && plane.rests ? "could not be read" : "not read yet",
    });
  return list;
}
