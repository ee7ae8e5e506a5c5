// Cells of a plane as an image.

/** Bits that a window of a map has for each of its pixels. */
export const SEVERAL = 1;
export const UNREAD = 2;
export const MISSING = 4;
/** Bits of a status that say that something is amiss with a cell. */
const AMISS = 2 | 4 | 8 | 16;
/** The status of a cell that is not computed. */
const NO_STATUS = 255;

const INK = 0xff1b1b1b;
const LIGHT = 0xfff2f2f2;
const MIDDLE = 0xffd0d0d0;
const DARK = 0xff9a9a9a;

/** The colours of all cells, image rows from the top, where y is largest. */
function coloured({ nx, ny, cells, colours }) {
  const pixels = new Uint32Array(nx * ny);
  for (let i = 0; i < nx; i++) {
    let [last, colour] = [NaN, colours.none];
    for (let j = 0, from = i * ny, to = (ny - 1) * nx + i; j < ny; j++, to -= nx) {
      const value = cells[from + j];
      if (value !== last) [last, colour] = [value, colours.pixel(value)];
      pixels[to] = colour;
    }
  }
  return pixels;
}

/** Puts marks on pixels: hatches where something is amiss, dots where several values are hidden. */
function mark(pixels, { nx, ny, status, bits }) {
  if (!status && !bits) return;
  for (let i = 0; i < nx; i++) {
    for (let j = 0, from = i * ny; j < ny; j++) {
      const to = (ny - 1 - j) * nx + i;
      const bit = bits ? bits[from + j] : 0;
      const flags = status ? status[from + j] : 0;
      if (bit & UNREAD) pixels[to] = (i + j) % 8 < 4 ? LIGHT : MIDDLE;
      else if (bit & MISSING || flags === NO_STATUS) pixels[to] = (i ^ j) & 4 ? MIDDLE : DARK;
      else if (flags & AMISS) pixels[to] = (i + j) % 5 === 0 ? INK : pixels[to];
      else if (bit & SEVERAL && (i + j) & 1) pixels[to] = INK;
    }
  }
}

/**
 * Paints the cells of a plane into a canvas of as many pixels.
 * @param {HTMLCanvasElement} canvas
 * @param {{nx: number, ny: number, cells: ArrayLike<number>, colours: object,
 *   status?: Uint8Array, bits?: Uint8Array}} plane cells by x, then y
 */
export function paint(canvas, plane) {
  const { nx, ny } = plane;
  if (canvas.width !== nx || canvas.height !== ny) [canvas.width, canvas.height] = [nx, ny];
  const pixels = coloured(plane);
  mark(pixels, plane);
  const image = new ImageData(new Uint8ClampedArray(pixels.buffer), nx, ny);
  canvas.getContext("2d").putImageData(image, 0, 0);
}

/** What marks mean that are in a plane, in words. */
export function marksOf({ status, bits }) {
  let [all, flags] = [0, false];
  for (const bit of bits ?? []) all |= bit;
  for (const flag of status ?? []) {
    if (flag === NO_STATUS) all |= bits ? 0 : MISSING;
    else if (flag & AMISS) flags = true;
  }
  const list = [];
  if (flags) list.push({ mark: "hatched", text: "marginal or not sure, see its status" });
  if (all & SEVERAL) list.push({ mark: "dotted", text: "hides several values: zoom in" });
  if (all & UNREAD) list.push({ mark: "striped", text: "not read yet" });
  if (all & MISSING) list.push({ mark: "checked", text: "not computed yet" });
  return list;
}
