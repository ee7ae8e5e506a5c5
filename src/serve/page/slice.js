// The line chart of a field along one axis of a map.

import { gapOf, tellNumber, valueOf } from "./cells.js";
import { element } from "./dom.js";
import { Newest } from "./newest.js";
import { linesIn } from "./plots.js";
import { begun, told } from "./scale.js";

const HEIGHT = 220;
/** How soon an unfinished line is asked for again, in milliseconds. */
const AGAIN = 240;
const [LEAST_PIXELS, MOST_PIXELS] = [100, 2048];
/** Room for a character of an axis, and beside it, in CSS pixels. */
const [CHARACTER, BESIDE] = [7.5, 18];
const TITLE = "Along one axis";

/** Steps of an axis of whole numbers. */
const WHOLE = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];

export class Slice {
  /**
   * @param {object} source see source.js
   * @param {(error: Error) => void} failed
   */
  constructor(source, failed) {
    this.target = element("slice");
    this.lines = new Newest(
      ({ id, query }, signal) => source.window(id, query, signal),
      (answer, asked) => this.#answered(answer, asked),
      (error) => {
        this.clear();
        failed(error);
      },
    );
    const width = () => this.line?.setSize({ width: this.#width(), height: HEIGHT });
    new ResizeObserver(width).observe(this.target);
    const dark = window.matchMedia("(prefers-color-scheme: dark)");
    dark.addEventListener("change", () => this.drawn && this.#draw(...this.drawn));
  }

  /**
   * Asks for a line through a cell.
   * @param {string} id of the map
   * @param {object} axis
   * @param {object} field
   * @param {string} at where it lies along the other axes
   */
  want(id, axis, field, at) {
    const w = Math.min(MOST_PIXELS, axis.points, Math.max(LEAST_PIXELS, this.#width()));
    const query = { field: field.name, x: axis.name, at, w, h: 1 };
    clearTimeout(this.again);
    this.wanted = { id, axis, field, query };
    this.lines.want(this.wanted);
  }

  /** Shows nothing and waits for nothing. */
  clear() {
    this.lines.stop();
    clearTimeout(this.again);
    this.line?.destroy();
    [this.wanted, this.line, this.drawn] = [null, null, null];
    element("slice-title").textContent = TITLE;
  }

  #width() {
    return Math.floor(this.target.clientWidth);
  }

  #answered(answer, asked) {
    this.#draw(answer, asked);
    if (answer.complete || asked !== this.wanted) return;
    this.again = setTimeout(() => asked === this.wanted && this.lines.want(asked), AGAIN);
  }

  #draw(answer, { axis, field }) {
    this.drawn = [answer, { axis, field }];
    const name = field.short_name ?? field.name;
    const unit = field.unit && field.unit !== "1" ? ` (${field.unit})` : "";
    const damage = answer.damage ? `; damaged: ${answer.damage}` : "";
    element("slice-title").textContent = `${begun(name)}${unit} along ${axis.symbol}${damage}`;
    const rows = rowsOf(answer, field);
    const data = [rows.map(([at]) => at), rows.map(([, value]) => value)];
    this.line?.destroy();
    const why = (place) => rows[place][2];
    this.line = new window.uPlot(this.#options(axis, field, data[1], why), data, this.target);
  }

  #options(axis, field, values, why) {
    const { colour, axis: styled } = linesIn(this.target);
    const text = (value) => (value === null ? "no value" : tellNumber(field, value));
    const room = (_, labels) =>
      BESIDE + CHARACTER * Math.max(3, ...(labels ?? []).map((label) => label.length));
    const up = { values: (_, list) => list.map(text), size: room };
    const scales = { x: { time: false } };
    if (field.kinds) {
      const found = [...new Set(values.filter((value) => value !== null))];
      const [low, high] = found.length ? [Math.min(...found), Math.max(...found)] : [0, 0];
      scales.y = { range: [low - 0.5, high + 0.5] };
      up.splits = () => found.toSorted((p, q) => p - q);
    } else if (field.storage !== "real") {
      up.incrs = WHOLE;
    }
    const stepped = field.storage === "real" ? undefined : window.uPlot.paths.stepped({ align: 0 });
    const unit = axis.unit === "1" ? "" : ` (${axis.unit})`;
    return {
      width: this.#width(),
      height: HEIGHT,
      scales,
      axes: [
        styled({ label: axis.symbol + unit, values: (_, list) => list.map((x) => told(x)) }),
        styled(up),
      ],
      series: [
        { label: axis.symbol, value: (_, x) => (x === null ? "" : told(x, 7)) },
        {
          label: field.short_name ?? field.name,
          value: (_, value, __, place) => (place === null ? "" : (why(place) ?? text(value))),
          width: 1.5,
          stroke: colour("calm"),
          spanGaps: false,
          paths: stepped,
        },
      ],
    };
  }
}

/**
 * Each cell once, as where it lies, its value, null where it has none that can be drawn, and why it
 * shows none.
 */
function rowsOf({ x, values, status, bits, gaps, shown }, field) {
  const cells = { field, cells: values, status, bits, gaps, shown };
  const rows = [];
  for (let i = 0; i < values.length; i++) {
    if (i > 0 && x.index[i] === x.index[i - 1]) continue;
    const [value, gap] = [valueOf(cells, i), gapOf(cells, i)];
    rows.push([x.values[i], Number.isFinite(value) && !gap ? value : null, gap?.text]);
  }
  return rows.sort((p, q) => p[0] - q[0]);
}
