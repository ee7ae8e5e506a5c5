// A plane of parameter space on a canvas: cells, curves over them, axes around, and a point.

import { BEYOND, paint } from "./cells.js";
import { areaWithin, drawFrame, placed } from "./frame.js";
import { CanvasPen, SvgPen } from "./pen.js";

/**
 * What is seen of a plane.
 * @typedef {object} Plane
 * @property {{name: string, symbol: string, unit: string, long_name?: string}[]} axes x and y
 * @property {import("./scale.js").Scale[]} ends of the image's edges, along x and y
 * @property {number} nx columns of cells
 * @property {number} ny rows
 * @property {ArrayLike<number>} cells by x, then y
 * @property {Uint8Array} [status]
 * @property {Uint8Array} [bits]
 * @property {object} field name, long_name, unit, kinds
 * @property {object} colours see colours.js
 * @property {{values: Float64Array, stable_side: number, degree_of_stability: number}[]} curves
 *   with their vertices as [x0, y0, x1, y1, …]
 */

export class PlaneView {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    this.image = document.createElement("canvas");
    /** @type {Plane | null} */
    this.plane = null;
    /** The scales of what is in view, x and y. */
    this.view = null;
    this.point = null;
    new ResizeObserver(() => this.draw()).observe(canvas);
    const dark = window.matchMedia("(prefers-color-scheme: dark)");
    dark.addEventListener("change", () => this.draw());
  }

  area() {
    return areaWithin({ width: this.canvas.clientWidth, height: this.canvas.clientHeight });
  }

  /** The values at a place on the canvas, of the nearest place in the area. */
  valueAt(x, y) {
    const area = this.area();
    const within = (part) => Math.min(1, Math.max(0, part));
    const parts = [within((x - area.x) / area.w), within(1 - (y - area.y) / area.h)];
    return this.view.map((scale, axis) => scale.value(parts[axis]));
  }

  /** Column and row of the cell nearest to a point; none outside of the image. */
  indexAt(point) {
    if (!this.plane) return null;
    const { nx, ny, ends } = this.plane;
    const index = (axis, n) => Math.floor(ends[axis].part(point[axis]) * n + 1e-9);
    const [i, j] = [index(0, nx), index(1, ny)];
    const there = (at, n) => at >= 0 && at <= n;
    return there(i, nx) && there(j, ny) ? [Math.min(i, nx - 1), Math.min(j, ny - 1)] : null;
  }

  /**
   * Shows a plane; the view stays.
   * @param {Plane} plane
   */
  show(plane) {
    this.plane = plane;
    plane.marks = paint(this.image, plane);
    this.draw();
  }

  draw() {
    if (!this.plane || !this.view || this.canvas.clientWidth === 0) return;
    this.drawWith(new CanvasPen(this.canvas));
  }

  drawWith(pen) {
    const area = areaWithin(pen);
    const { axes } = this.plane;
    pen.box(area, { fill: pen.colour("empty") });
    pen.within(area, () => {
      pen.image(this.image, this.#imageBox(area));
      this.#drawCurves(pen, area);
      if (this.point) this.#drawPoint(pen, area);
    });
    drawFrame(pen, area, this.view, axes);
  }

  /** Where the image lies, whose scale is that of the view. */
  #imageBox(area) {
    const [xs, ys] = this.plane.ends;
    const [left, top] = placed(area, this.view, [xs.value(0), ys.value(1)]);
    const [right, bottom] = placed(area, this.view, [xs.value(1), ys.value(0)]);
    return { x: left, y: top, w: right - left, h: bottom - top };
  }

  #drawCurves(pen, area) {
    const colour = pen.colour("curve");
    for (const { values, stable_side: side, degree_of_stability: degree } of this.plane.curves) {
      const points = new Float64Array(values.length);
      for (let k = 0; k + 1 < values.length; k += 2) {
        const [x, y] = placed(area, this.view, [values[k], values[k + 1]]);
        [points[k], points[k + 1]] = [x, y];
      }
      const bounds = degree === 0 && side !== 0;
      pen.line(points, { colour, width: bounds ? 2 : 0.8, dash: degree > 0 ? [5, 3] : [] });
    }
  }

  #drawPoint(pen, area) {
    const [x, y] = placed(area, this.view, this.point);
    for (const [colour, width] of [
      [pen.colour("halo"), 5],
      [pen.colour("mark"), 2],
    ]) {
      pen.disc([x, y], 6, { stroke: colour, width });
      for (const [dx, dy] of [
        [1, 0],
        [-1, 0],
        [0, 1],
        [0, -1],
      ]) {
        pen.line([x + 6 * dx, y + 6 * dy, x + 12 * dx, y + 12 * dy], { colour, width });
      }
    }
  }

  /** The file of what is seen. */
  svg() {
    const pen = new SvgPen(this.canvas);
    this.drawWith(pen);
    return pen.file();
  }

  /** The same as pixels. */
  png() {
    return new Promise((done) => this.canvas.toBlob(done, "image/png"));
  }

  /** Every cell that is seen: both values, the field, and its status where there is one. */
  csv() {
    const { axes, ends, nx, ny, cells, status, bits, field, at } = this.plane;
    const [xs, ys] = ends;
    const value = (scale, i, n, exact) => exact?.[i] ?? scale.value((i + 0.5) / n);
    const lines = [`# ${field.name}: ${field.long_name ?? ""} (${field.unit ?? "1"})`];
    for (const [name, text] of at ?? []) lines.push(`# ${name} = ${text}`);
    const extra = [status && "status", bits && "marks"].filter(Boolean);
    lines.push([axes[0].name, axes[1].name, field.name, ...extra].join(","));
    for (let i = 0; i < nx; i++) {
      const x = value(xs, i, nx, axes[0].values);
      for (let j = 0; j < ny; j++) {
        const n = i * ny + j;
        if (bits?.[n] & BEYOND) continue;
        const more = [status?.[n], bits?.[n]].filter((flag) => flag !== undefined);
        lines.push([x, value(ys, j, ny, axes[1].values), cells[n], ...more].join(","));
      }
    }
    return `${lines.join("\n")}\n`;
  }
}
