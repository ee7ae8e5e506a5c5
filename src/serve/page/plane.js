// A plane of parameter space on a canvas: cells, curves over them, axes around, and a point.

import { isBeyond, lacking, paint, tellNumber, valueOf } from "./cells.js";
import { areaWithin, drawFrame, placed } from "./frame.js";
import { CanvasPen } from "./pen.js";
import { pngOf, svgOf } from "./picture.js";

/**
 * What is seen of a plane.
 * @typedef {object} Plane
 * @property {{name: string, symbol: string, unit: string, long_name?: string, points?: number,
 *   values?: ArrayLike<number>, index?: ArrayLike<number>}[]} axes x and y, or x alone; with the
 *   values of the cells that its pixels show and, of a map, their indices
 * @property {import("./scale.js").Scale[]} ends of the image's edges, along x and y
 * @property {number} nx columns of cells
 * @property {number} ny rows
 * @property {ArrayLike<number>} cells by x, then y
 * @property {Uint8Array} [status]
 * @property {Uint8Array} [bits]
 * @property {Uint8Array} [gaps] why cells show no value, by the numbers of `shown`
 * @property {object} shown what slipmap tells of the colours of its cells
 * @property {object} field name, long_name, unit, kinds
 * @property {{name: string, symbol: string, unit: string, value: number}[]} [fixed] parameters that
 *   are no axes here
 * @property {string} [from] the title of the map that it is of
 * @property {{mask: number, name: string}[]} [flagNames] those of its status
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
    /** The best setting with the box of the robust one, and another point that is compared, with
     * the names of its axes. */
    [this.best, this.other] = [null, null];
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

  /** Shows nothing. */
  clear() {
    [this.plane, this.point] = [null, null];
    const { width, height } = this.canvas;
    const context = this.canvas.getContext("2d");
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, width, height);
  }

  draw() {
    if (!this.plane || !this.view || this.canvas.clientWidth === 0) return;
    this.drawWith(new CanvasPen(this.canvas));
  }

  /** Draws what is seen into an area, with the point where it is wanted. */
  drawWith(pen, area = areaWithin(pen), point = this.point) {
    const { axes } = this.plane;
    pen.box(area, { fill: pen.colour("empty") });
    pen.within(area, () => {
      pen.image(this.image, this.#imageBox(area));
      const shade = pen.colour("shade");
      if (shade) pen.box(area, { fill: shade });
      this.#drawCurves(pen, area);
      if (point && this.best) this.#drawBest(pen, area);
      // Only where its axes are those that are seen.
      const there = this.other?.of.every((name, i) => name === axes[i]?.name);
      if (point && there) this.#drawPoint(pen, area, this.other.at, "calm");
      if (point) this.#drawPoint(pen, area, point, "mark");
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

  #drawBest(pen, area) {
    const { point, box } = this.best;
    const lines = [];
    if (box) {
      const [xs, ys] = box;
      const corners = [0, 1, 1, 0, 0].map((i, k) => [xs[i], ys[k < 2 || k === 4 ? 0 : 1]]);
      lines.push(corners.flatMap((corner) => placed(area, this.view, corner)));
    }
    const [x, y] = placed(area, this.view, point);
    for (const turn of [0, 1, 2, 3]) {
      const [dx, dy] = [Math.cos((turn * Math.PI) / 4), Math.sin((turn * Math.PI) / 4)];
      lines.push([x - 8 * dx, y - 8 * dy, x + 8 * dx, y + 8 * dy]);
    }
    for (const [colour, width] of [
      [pen.colour("halo"), 5],
      [pen.colour("curve"), 2],
    ]) {
      for (const line of lines) pen.line(line, { colour, width });
    }
  }

  #drawPoint(pen, area, point, ink) {
    const [x, y] = placed(area, this.view, point);
    for (const [colour, width] of [
      [pen.colour("halo"), 5],
      [pen.colour(ink), 2],
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

  /** A file of what is seen, with a title and the legend, without the point. */
  svg(title) {
    return svgOf(this, title);
  }

  /** The same as pixels. */
  png(title) {
    return pngOf(this, title);
  }

  /** Every cell that is seen, once: its values along the axes, the field's, and its status. */
  csv() {
    const { axes, status, field } = this.plane;
    const [xs, ys] = [0, 1].map((axis) => this.#seen(axis));
    const lacks = (n) => lacking(this.plane, n);
    const lackIn = xs.some(({ i }) => ys.some(({ i: j }) => lacks(i * this.plane.ny + j)));
    const extra = [status && "status", lackIn && "lacking"].filter(Boolean);
    const lines = [...this.#header(xs, ys)];
    lines.push([...axes.map(({ name }) => name), field.name, ...extra].join(","));
    for (const { i, value: x } of xs) {
      for (const { i: j, value: y } of ys) {
        const n = i * this.plane.ny + j;
        const [lack, value] = [lacks(n), valueOf(this.plane, n)];
        const kind = field.kinds ? tellNumber(field, value) : value;
        const row = [...[x, y].slice(0, axes.length), Number.isNaN(value) ? "" : kind];
        if (status) row.push(lack ? "" : status[n]);
        if (lackIn) row.push(lack ?? "");
        lines.push(row.join(","));
      }
    }
    return `${lines.join("\n")}\n`;
  }

  /** Pixels along an axis that show different cells, and the values of these. */
  #seen(axis) {
    const { axes, ends, nx, ny } = this.plane;
    const [shown, n] = [axes[axis], [nx, ny][axis]];
    const across = Array.from({ length: (nx * ny) / n }, (_, j) => j);
    const place = (i, j) => (axis === 0 ? i * ny + j : j * ny + i);
    const there = (i) => across.some((j) => !isBeyond(this.plane, place(i, j)));
    const all = Array.from({ length: n }, (_, i) => i).filter(there);
    const first = ({ index }) => all.filter((i, k) => k === 0 || index[i] !== index[all[k - 1]]);
    return (shown?.index ? first(shown) : all).map((i) => ({
      i,
      value: shown?.values?.[i] ?? ends[axis].value((i + 0.5) / n),
    }));
  }

  /** What a file of cells says before them. */
  *#header(xs, ys) {
    const { axes, field, fixed = [], flagNames = [], note, rests } = this.plane;
    const line = (text) => `# ${String(text).replace(/\s+/g, " ")}`;
    yield line(`${field.name}: ${field.long_name ?? ""} (${field.unit ?? "1"})`);
    for (const { name, value } of fixed) yield line(`${name} = ${value}`);
    for (const [axis, { index, name, points }] of axes.entries()) {
      if (!index) continue;
      const count = [xs, ys][axis].length;
      const [first, last] = [index[0], index[index.length - 1]];
      const all = count === Math.abs(last - first) + 1;
      const why = all ? "all in view" : "those that pixels show, others lie between them";
      yield line(`along ${name} ${count} of ${points} values, ${why}`);
    }
    if (flagNames.length) {
      const flags = flagNames.map(({ mask, name }) => `${mask} ${name}`);
      yield line(`status: the sum of ${flags.join(", ")}`);
    }
    if (axes[0].index && !rests) yield line(`not all was read yet: ${note}`);
  }
}
