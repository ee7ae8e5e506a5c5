// Counts as colours, curves over them, and axes around both.

/** Colours of 0, 2, 4, 6 and more unstable roots, told apart without colour vision as well. */
export const COLOURS = ["#fdf6e3", "#7fb3d5", "#3c78a8", "#1f4e79", "#0b2545"];
export const NAMES = ["stable", "2 unstable roots", "4", "6", "8 or more"];
const MARGIN = { left: 62, right: 14, top: 10, bottom: 46 };

const INTS = COLOURS.map((colour) => {
  const [r, g, b] = [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
  return (255 << 24) | (b << 16) | (g << 8) | r;
});

/** Round numbers between two, at most `most` of them. */
export function ticks(from, to, most) {
  const rough = (to - from) / most;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((n) => n * power).find((s) => s >= rough);
  const list = [];
  for (let n = Math.ceil(from / step); n * step <= to + 1e-9 * step; n++) list.push(n * step);
  return list;
}

const told = (x) => (Math.abs(x) < 1e-12 ? "0" : Number(x.toPrecision(6)).toString());

/** Draws charts into a canvas; x is the first axis of a chart, y the second. */
export class ChartView {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
    this.cells = document.createElement("canvas");
    this.chart = null;
    this.point = null;
  }

  /** The area of the cells, in CSS pixels. */
  area() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const [w, h] = [width - MARGIN.left - MARGIN.right, height - MARGIN.top - MARGIN.bottom];
    return { x: MARGIN.left, y: MARGIN.top, w, h };
  }

  ends(axis) {
    const values = this.chart.axes[axis].values;
    return [values[0], values[values.length - 1]];
  }

  /** From values to CSS pixels, and back. */
  place([p, q]) {
    const area = this.area();
    const [[p0, p1], [q0, q1]] = [this.ends(0), this.ends(1)];
    return [area.x + ((p - p0) / (p1 - p0)) * area.w, area.y + ((q1 - q) / (q1 - q0)) * area.h];
  }

  valueAt(x, y) {
    const area = this.area();
    const [[p0, p1], [q0, q1]] = [this.ends(0), this.ends(1)];
    const within = (part) => Math.min(1, Math.max(0, part));
    const p = p0 + within((x - area.x) / area.w) * (p1 - p0);
    return [p, q1 - within((y - area.y) / area.h) * (q1 - q0)];
  }

  show(chart) {
    this.chart = chart;
    const [columns, rows] = chart.axes.map((axis) => axis.values.length);
    const counts = chart.fields[0].values;
    if (this.cells.width !== columns || this.cells.height !== rows) {
      [this.cells.width, this.cells.height] = [columns, rows];
    }
    const pixels = new Uint32Array(columns * rows);
    for (let i = 0; i < columns; i++) {
      for (let j = 0; j < rows; j++) {
        const colour = Math.min(INTS.length - 1, Math.ceil(counts[i * rows + j] / 2));
        pixels[(rows - 1 - j) * columns + i] = INTS[colour];
      }
    }
    const image = new ImageData(new Uint8ClampedArray(pixels.buffer), columns, rows);
    this.cells.getContext("2d").putImageData(image, 0, 0);
    this.draw();
  }

  draw() {
    if (!this.chart) return;
    const { canvas, context } = this;
    const scale = window.devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    [canvas.width, canvas.height] = [Math.round(width * scale), Math.round(height * scale)];
    context.setTransform(scale, 0, 0, scale, 0, 0);
    const style = getComputedStyle(canvas);
    const area = this.area();
    context.imageSmoothingEnabled = false;
    context.drawImage(this.cells, area.x, area.y, area.w, area.h);
    this.drawCurves(area, style.getPropertyValue("--curve"));
    this.drawAxes(area, style.color);
    if (this.point) this.drawPoint(style.getPropertyValue("--mark"));
  }

  drawCurves(area, colour) {
    const { context } = this;
    context.save();
    context.beginPath();
    context.rect(area.x, area.y, area.w, area.h);
    context.clip();
    context.strokeStyle = colour;
    for (const curve of this.chart.curves) {
      context.lineWidth = curve.stable_side === 0 ? 0.7 : 2;
      context.beginPath();
      for (let k = 0; k + 1 < curve.values.length; k += 2) {
        context.lineTo(...this.place([curve.values[k], curve.values[k + 1]]));
      }
      context.stroke();
    }
    context.restore();
  }

  drawAxes(area, ink) {
    const { context } = this;
    [context.fillStyle, context.strokeStyle, context.lineWidth] = [ink, ink, 1];
    context.font = "13px system-ui, sans-serif";
    context.strokeRect(area.x, area.y, area.w, area.h);
    const [p, q] = this.chart.axes;
    const title = (axis) => `${axis.symbol}${axis.unit === "1" ? "" : ` (${axis.unit})`}`;
    [context.textAlign, context.textBaseline] = ["center", "top"];
    for (const tick of ticks(...this.ends(0), Math.max(2, area.w / 80))) {
      const [x] = this.place([tick, 0]);
      context.fillRect(x, area.y + area.h, 1, 5);
      context.fillText(told(tick), x, area.y + area.h + 8);
    }
    context.fillText(title(p), area.x + area.w / 2, area.y + area.h + 26);
    [context.textAlign, context.textBaseline] = ["right", "middle"];
    for (const tick of ticks(...this.ends(1), Math.max(2, area.h / 50))) {
      const [, y] = this.place([0, tick]);
      context.fillRect(area.x - 5, y, 5, 1);
      context.fillText(told(tick), area.x - 8, y);
    }
    context.save();
    context.translate(14, area.y + area.h / 2);
    context.rotate(-Math.PI / 2);
    context.textAlign = "center";
    context.fillText(title(q), 0, 0);
    context.restore();
  }

  drawPoint(colour) {
    const { context } = this;
    const [x, y] = this.place(this.point);
    [context.strokeStyle, context.lineWidth] = [colour, 2];
    context.beginPath();
    context.arc(x, y, 6, 0, 2 * Math.PI);
    context.moveTo(x - 11, y);
    context.lineTo(x + 11, y);
    context.moveTo(x, y - 11);
    context.lineTo(x, y + 11);
    context.stroke();
  }

  /** The number of unstable roots in the cell of a point. */
  countAt([p, q]) {
    const index = (axis, value) => {
      const [from, to] = this.ends(axis);
      const last = this.chart.axes[axis].values.length - 1;
      return Math.round(((value - from) / (to - from)) * last);
    };
    const rows = this.chart.axes[1].values.length;
    return this.chart.fields[0].values[index(0, p) * rows + index(1, q)];
  }
}
