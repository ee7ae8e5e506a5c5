// Cells of a plane: what they hold, in words, and as an image.

import { told } from "./scale.js";

/** Bits that a window of a map has for each of its pixels. */
const SEVERAL = 1;
const UNREAD = 2;
const MISSING = 4;
const BEYOND = 8;
/** Bits of a status that say that something is amiss with a cell. */
const AMISS = 2 | 4 | 8 | 16 | 64;
/** The status of a cell that is not computed. */
const NO_STATUS = 255;
/** What stands for no value, by how a field is stored; NaN for real numbers. */
const FILLS = { count: 65535, kind: 255, few: 255 };

const INK = 0xff1b1b1b;
const LIGHT = 0xfff2f2f2;
const MIDDLE = 0xffd0d0d0;
const DARK = 0xff9a9a9a;

/** Whether a pixel lies beyond the map. */
export const isBeyond = ({ bits }, n) => Boolean(bits?.[n] & BEYOND);

/** Why nothing is known of the cell of a pixel, in words; none where something is. */
export function lacking({ status, bits, damage, rests }, n) {
  if (bits?.[n] & BEYOND) return "beyond the map";
  if (bits?.[n] & UNREAD) return damage && rests ? "could not be read" : "not read yet";
  if (bits?.[n] & MISSING || status?.[n] === NO_STATUS) return "not computed yet";
  return null;
}

/** The value of the cell of a pixel; NaN where there is none. */
export function valueOf(plane, n) {
  const value = plane.cells[n];
  return lacking(plane, n) || value === FILLS[plane.field.storage] ? NaN : value;
}

/** The values of a plane that are there: those that stand for none would stretch its colours. */
export function valuesOf(plane) {
  const { cells, status, bits, field } = plane;
  const lacks = (n) => (bits && bits[n] & (UNREAD | MISSING | BEYOND)) || status?.[n] === NO_STATUS;
  const fill = FILLS[field.storage];
  let count = 0;
  const found = new Float64Array(cells.length);
  for (let n = 0; n < cells.length; n++) {
    if (!lacks(n) && cells[n] !== fill) found[count++] = cells[n];
  }
  return found.subarray(0, count);
}

/** A value of a field as people read it: kinds by their names. */
export function tellNumber({ kinds }, value) {
  return kinds ? (kinds[value] ?? "no value") : told(value);
}

/** What else a pixel says besides its value, `flags` being those that a status can have. */
export function flagsOf(plane, flags, n) {
  if (lacking(plane, n)) return [];
  const list = flags.filter(({ mask }) => plane.status?.[n] & mask).map(({ name }) => name);
  if (plane.bits?.[n] & SEVERAL) list.unshift("other values are hidden here: zoom in");
  return list;
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

/** Puts marks on pixels: hatches where something is amiss, dots where several values are hidden. */
function mark(pixels, { nx, ny, status, bits }) {
  for (let i = 0, n = 0; i < nx; i++) {
    for (let j = 0; j < ny; j++, n++) {
      const bit = bits ? bits[n] : 0;
      const flags = status ? status[n] : 0;
      if (bit & BEYOND) pixels[n] = 0;
      else if (bit & UNREAD) pixels[n] = (i + j) % 8 < 4 ? LIGHT : MIDDLE;
      else if (bit & MISSING || flags === NO_STATUS) pixels[n] = (i ^ j) & 4 ? MIDDLE : DARK;
      else if (flags & AMISS) pixels[n] = (i + j) % 5 === 0 ? INK : pixels[n];
      else if (bit & SEVERAL && (i + j) & 1) pixels[n] = INK;
    }
  }
}

/** Which marks a plane needs: all bits of its pixels, and whether some status says that something is amiss. */
function needed({ status, bits }) {
  let [all, flags] = [0, 0];
  if (bits) for (let n = 0; n < bits.length; n++) all |= bits[n];
  if (status) {
    for (let n = 0; n < status.length; n++) {
      if (status[n] === NO_STATUS) all |= bits ? 0 : MISSING;
      else flags |= status[n];
    }
  }
  return { all, amiss: (flags & AMISS) !== 0 };
}

/**
 * Paints the cells of a plane into a canvas of as many pixels, x downwards and y to the right.
 * @param {HTMLCanvasElement} canvas
 * @param {{nx: number, ny: number, cells: ArrayLike<number>, colours: object,
 *   status?: Uint8Array, bits?: Uint8Array}} plane cells by x, then y
 * @returns {{mark: string, text: string}[]} what the marks mean that are in it
 */
export function paint(canvas, plane) {
  const { nx, ny } = plane;
  if (canvas.width !== ny || canvas.height !== nx) [canvas.width, canvas.height] = [ny, nx];
  const pixels = coloured(plane);
  const { all, amiss } = needed(plane);
  if (all || amiss) mark(pixels, plane);
  const image = new ImageData(new Uint8ClampedArray(pixels.buffer), ny, nx);
  canvas.getContext("2d").putImageData(image, 0, 0);
  const list = [];
  if (amiss) list.push({ mark: "hatched", text: "marginal or not sure, see its status" });
  if (all & SEVERAL) list.push({ mark: "dotted", text: "hides several values: zoom in" });
  if (all & UNREAD)
    list.push({
      mark: "striped",
      text: plane.damage && plane.rests ? "could not be read" : "not read yet",
    });
  if (all & MISSING) list.push({ mark: "checked", text: "not computed yet" });
  return list;
}
