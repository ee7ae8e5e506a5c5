// Maps from files: their list, and views of one of them.

import { coloursOf } from "./colours.js";
import { element, make, terms } from "./dom.js";
import { Newest } from "./newest.js";
import { Scale, told } from "./scale.js";

/** How often the list is looked at, while the page is seen; in milliseconds. */
const LOOK = 2500;
/** How soon an unfinished view is asked for again. */
const AGAIN = 60;
/** The most pixels of a window each way. */
const MOST_PIXELS = 2048;
/** In all: more of a field of real numbers is refused. */
const MOST_IN_ALL = 2 ** 21;
const LINE_HEIGHT = 220;

const ages = [
  [86400, "day"],
  [3600, "hour"],
  [60, "minute"],
  [1, "second"],
];

/** How long ago, in words. */
function age(seconds) {
  const [size, word] = ages.find(([s]) => seconds >= s) ?? [1, "second"];
  const count = Math.max(0, Math.floor(seconds / size));
  return `${count} ${word}${count === 1 ? "" : "s"} ago`;
}

export class Saved {
  /**
   * @param {object} source
   * @param {object} state
   * @param {import("./plane.js").PlaneView} plane
   * @param {{shown: Function, opened: Function, look: Function, changed: Function,
   *   failed: Function}} told
   */
  constructor(source, state, plane, told_) {
    Object.assign(this, { source, state, plane, told: told_ });
    this.windows = new Newest(
      (query, signal) => source.window(this.map.id, query, signal),
      (answer, query) => this.#show(answer, query),
      (error) => this.#failed(error),
    );
    this.lines = new Newest(
      (query, signal) => source.window(this.map.id, query, signal),
      (answer) => this.#showLine(answer),
      told_.failed,
    );
    this.cells = new Newest(
      (at, signal) => source.cell(this.map.id, { at }, signal),
      (cell) => this.#showCell(cell),
      told_.failed,
    );
    this.#listen();
  }

  /** Looks at the list, again and again. */
  async begin() {
    const look = async () => {
      if (document.visibilityState === "visible") await this.#list();
      setTimeout(look, LOOK);
    };
    await look();
  }

  async #list() {
    try {
      const { folder, maps } = await this.source.maps();
      element("to-maps").hidden = maps.length === 0;
      element("to-maps").textContent = `Maps (${maps.length})`;
      element("maps-title").textContent = `Maps in ${folder}`;
      this.#tellList(maps);
      const own = maps.find(({ id }) => id === this.map?.id);
      const grown =
        own && (own.cells_done !== this.seen.cells_done || own.state !== this.seen.state);
      if (grown && this.state.map) await this.#describe();
    } catch (error) {
      // A folder that was not given is no mistake; a server that is gone is told elsewhere.
      if (error.status !== 404) this.told.failed(error);
    }
  }

  #tellList(maps) {
    const key = JSON.stringify(
      maps.map((map) => ({ ...map, age_seconds: Math.floor(map.age_seconds / 60) })),
    );
    if (key === this.listed) return;
    this.listed = key;
    const words = ["Map", "State", "Axes", "Fields", "Cells", "Changed"];
    const head = make("tr", {}, ...words.map((word) => make("th", { scope: "col" }, word)));
    const rows = maps.map((map) => this.#row(map));
    const [table, focused] = [element("maps-table"), document.activeElement?.dataset?.map];
    table.replaceChildren(make("thead", {}, head), make("tbody", {}, ...rows));
    if (focused) table.querySelector(`[data-map="${focused}"]`)?.focus();
  }

  #row(map) {
    const share = map.cells ? Math.floor((100 * map.cells_done) / map.cells) : 0;
    const partial = ["running", "interrupted"].includes(map.state);
    const state = partial ? `${map.state}, ${share} %` : map.state;
    const axes = (map.axes ?? []).map(({ symbol, points }) => `${symbol} (${points})`).join(" × ");
    const button = make("button", { type: "button", className: "link" }, map.name);
    button.dataset.map = map.id;
    button.disabled = !(map.axes ?? []).length;
    button.addEventListener("click", () => {
      this.state.map = { id: map.id, at: {} };
      element("maps").hidden = true;
      this.told.opened();
      element("chart-title").focus();
    });
    const cells = map.cells ? map.cells.toLocaleString("en") : "";
    const texts = [
      map.why ? `${state}: ${map.why}` : state,
      axes,
      (map.fields ?? []).join(", "),
      cells,
      map.age_seconds === undefined ? "" : age(map.age_seconds),
    ];
    const row = make("tr", {}, make("th", { scope: "row" }, button));
    row.append(...texts.map((text) => make("td", {}, text)));
    row.className = map.state;
    return row;
  }

  #listen() {
    element("to-maps").addEventListener("click", () => {
      const list = element("maps");
      list.hidden = !list.hidden;
      element("to-maps").setAttribute("aria-expanded", String(!list.hidden));
    });
    element("map").addEventListener("submit", (event) => event.preventDefault());
    const set = (id, key, read) =>
      element(id).addEventListener("change", (event) => {
        const { map } = this.state;
        const before = map[key];
        map[key] = read(event.target);
        if (key === "x" || key === "y") this.#axesChosen(key, before);
        if (key === "xlog" || key === "ylog") this.#allInView();
        this.#build();
        this.#ask();
      });
    set("field", "field", ({ value }) => value);
    set("map-x", "x", ({ value }) => value);
    set("map-y", "y", ({ value }) => value);
    set("x-log", "xlog", ({ checked }) => checked);
    set("y-log", "ylog", ({ checked }) => checked);
    element("slice-axis").addEventListener("change", (event) => {
      this.state.map.slice = event.target.value;
      this.#askLine();
    });
  }

  /** Opens the map that the state names. */
  async open() {
    this.curves = { key: null, list: [] };
    [this.map, this.range] = [null, null];
    await this.#describe();
  }

  /** No map is looked at any more. */
  close() {
    for (const requests of [this.windows, this.lines, this.cells]) requests.stop();
    clearTimeout(this.again);
    element("reading").hidden = true;
    this.map = null;
  }

  async #describe() {
    const { id } = this.state.map;
    try {
      const map = await this.source.map(id);
      if (this.state.map?.id !== id) return;
      this.map = map;
      this.seen = { cells_done: map.cells_done, state: map.state };
      this.#begin();
      this.#build();
      this.#ask();
      this.look();
    } catch (error) {
      this.#failed(error);
    }
  }

  #failed(error) {
    element("reading").hidden = true;
    this.told.failed(error);
  }

  /** Fills in what the state does not say, and drops what the map does not have. */
  #begin() {
    const { map } = this.state;
    const names = this.map.axes.map(({ name }) => name);
    const fields = this.map.fields.map(({ name }) => name);
    if (!fields.includes(map.field)) [map.field] = fields;
    const long = this.map.axes.filter(({ points }) => points > 1).map(({ name }) => name);
    const [p, q] = this.map.curves_plane ?? long.slice(-2);
    if (!names.includes(map.x)) map.x = p ?? names[0];
    if (!names.includes(map.y) || map.y === map.x) {
      map.y = [q, ...long, ...names].find((name) => name && name !== map.x) ?? null;
    }
    if (!names.includes(map.slice)) map.slice = map.y ?? map.x;
    for (const axis of this.map.axes) {
      const at = map.at[axis.name];
      map.at[axis.name] = Math.min(
        axis.points - 1,
        Number.isInteger(at) ? at : Math.floor(axis.points / 2),
      );
    }
    if (!this.plane.view || !this.range) this.#setView(map.xr, map.yr);
  }

  #axis(name) {
    return this.map.axes.find((axis) => axis.name === name);
  }

  /** The scale of a whole axis; of one value, with room around it. */
  #whole(name, log) {
    const axis = this.#axis(name);
    if (!axis) return new Scale(0, 1);
    const [low, high] = axis.from < axis.to ? [axis.from, axis.to] : [axis.to, axis.from];
    const room = low === high ? Math.abs(low) / 2 || 0.5 : 0;
    return new Scale(low - room, high + room, log);
  }

  #setView(xr, yr) {
    const { map } = this.state;
    this.range = [this.#whole(map.x, map.xlog), this.#whole(map.y, map.ylog)];
    const part = (pair, whole) => (pair ? new Scale(pair[0], pair[1], whole.log) : whole);
    this.plane.view = [part(xr, this.range[0]), part(yr, this.range[1])];
  }

  #allInView() {
    Object.assign(this.state.map, { xr: null, yr: null });
    this.#setView(null, null);
    this.plane.plane = null;
  }

  /** Where both axes are the same now, the other one takes the place of this one. */
  #axesChosen(key, before) {
    const { map } = this.state;
    const other = key === "x" ? "y" : "x";
    if (map[key] === map[other]) {
      map[other] = before;
      [map.xlog, map.ylog] = [map.ylog, map.xlog];
    }
    map.point = null;
    this.#allInView();
  }

  /** Makes the form from the map. */
  #build() {
    const { map } = this.state;
    element("map-title").textContent = this.map.title || this.map.name;
    const scalars = (this.map.scalars ?? []).filter(({ value }) => value !== 1 && value !== 0);
    const state =
      this.map.state === "complete"
        ? "complete"
        : `${this.map.state}, ${this.map.cells_done.toLocaleString("en")} cells are there`;
    terms(element("map-told"), [
      ["file", this.map.name],
      ["state", `${state}; ${this.map.cells.toLocaleString("en")} cells`],
      ...scalars.map(({ symbol, value, unit }) => [
        symbol,
        told(value) + (unit === "1" ? "" : ` ${unit}`),
      ]),
    ]);
    const options = (id, list, value) => {
      const select = element(id);
      select.replaceChildren(...list.map(([name, text]) => make("option", { value: name }, text)));
      select.value = value;
    };
    const axes = this.map.axes.map(({ name, symbol }) => [name, symbol]);
    options(
      "field",
      this.map.fields.map((f) => [f.name, f.short_name ?? f.name]),
      map.field,
    );
    options("map-x", axes, map.x);
    options("map-y", axes, map.y);
    options("slice-axis", axes, map.slice);
    [element("x-log").checked, element("y-log").checked] = [Boolean(map.xlog), Boolean(map.ylog)];
    const others = this.map.axes.filter(({ name }) => name !== map.x && name !== map.y);
    element("map-sliders").replaceChildren(...others.map((axis) => this.#slider(axis)));
  }

  #slider(axis) {
    const { map } = this.state;
    const range = make("input", {
      type: "range",
      id: `at-${axis.name}`,
      min: 0,
      max: axis.points - 1,
      step: 1,
    });
    range.value = map.at[axis.name];
    const output = make("output", { htmlFor: range.id });
    const tell = (value) => (output.value = value === undefined ? "" : told(value, 7));
    tell(axis.values?.[map.at[axis.name]]);
    output.dataset.axis = axis.name;
    range.addEventListener("input", () => {
      map.at[axis.name] = range.valueAsNumber;
      tell(axis.values?.[range.valueAsNumber]);
      this.#ask();
    });
    const text = `${axis.symbol}, ${axis.long_name}`;
    return make(
      "div",
      { className: "slider" },
      make("label", { htmlFor: range.id }, text),
      range,
      output,
    );
  }

  #at(without) {
    const { map } = this.state;
    const others = this.map.axes.filter(({ name }) => !without.includes(name));
    return others.map(({ name }) => `${name}:${map.at[name]}`).join(",");
  }

  /** Asks for what is in view. */
  #ask() {
    const { map } = this.state;
    const { w, h } = this.plane.area();
    const [xs, ys] = this.plane.view;
    const part = Math.min(1, Math.sqrt(MOST_IN_ALL / (w * h)));
    const pixels = (length) => Math.min(MOST_PIXELS, Math.max(1, Math.floor(part * length)));
    const query = {
      field: map.field,
      x: map.x,
      at: this.#at([map.x, map.y]),
      w: pixels(w),
      h: pixels(h),
      x0: xs.from,
      x1: xs.to,
      xscale: xs.log ? "log" : "linear",
    };
    if (map.y)
      Object.assign(query, { y: map.y, y0: ys.from, y1: ys.to, yscale: ys.log ? "log" : "linear" });
    else query.h = 1;
    clearTimeout(this.again);
    this.windows.want(query);
    this.#askCurves();
    this.#askLine();
    this.told.changed();
  }

  async #askCurves() {
    const { map } = this.state;
    const query = { x: map.x, y: map.y ?? "", at: this.#at([map.x, map.y]) };
    const plane = this.map.curves_plane;
    const there = plane && plane.includes(map.x) && plane.includes(map.y);
    const key = JSON.stringify([this.map.version, query]);
    if (this.curves.key === key) return;
    this.curves = { key, list: [] };
    if (!there) return;
    try {
      const { curves } = await this.source.curves(this.map.id, query);
      if (this.curves.key !== key) return;
      this.curves.list = curves;
      if (this.plane.plane) {
        this.plane.plane.curves = this.curves.list;
        this.plane.draw();
      }
    } catch (error) {
      this.told.failed(error);
    }
  }

  #show(answer, query) {
    const { map } = this.state;
    if (!this.map || answer.field !== map.field) return;
    const field = this.map.fields.find(({ name }) => name === answer.field);
    const axes = [map.x, map.y].map((name, i) => {
      const found = (i === 0 ? answer.x : answer.y) ?? { values: [0] };
      return {
        ...(this.#axis(name) ?? { symbol: "", unit: "1" }),
        values: found.values,
        index: found.index,
      };
    });
    const ends = [
      new Scale(query.x0, query.x1, query.xscale === "log"),
      map.y ? new Scale(query.y0, query.y1, query.yscale === "log") : new Scale(0, 1),
    ];
    const flags = (n) => this.#flags(answer, n);
    this.#placePoint(axes);
    this.told.shown({
      axes,
      ends,
      field,
      flags,
      nx: axes[0].values.length,
      ny: axes[1].values.length,
      cells: answer.values,
      status: answer.status,
      bits: answer.bits,
      colours: coloursOf(field, answer.values),
      curves: this.curves.list,
      at: (answer.at ?? []).map(({ name, value }) => [name, value]),
      milliseconds: answer.milliseconds,
      note: answer.damage
        ? `damaged: ${answer.damage}`
        : answer.complete
          ? `read in ${answer.milliseconds.toFixed(0)} ms`
          : `reading, ${Math.floor(100 * answer.progress)} %`,
      exact: true,
      rests: answer.complete,
    });
    for (const { name, value } of answer.at ?? []) {
      const output = element("map-sliders").querySelector(`output[data-axis="${name}"]`);
      if (output && !output.value) output.value = told(value, 7);
    }
    element("reading").hidden = answer.complete;
    element("reading").value = answer.progress;
    clearTimeout(this.again);
    if (!answer.complete)
      this.again = setTimeout(() => this.map && this.windows.want(query), AGAIN);
  }

  /** The cell of the state, as a point of the plane. */
  #placePoint(axes) {
    const { map } = this.state;
    const index = [map.x, map.y].map((name) => map.at[name] ?? 0);
    const values = axes.map((axis, i) => {
      const pixel = axis.index?.indexOf(index[i]) ?? -1;
      return this.#axis(axis.name)?.values?.[index[i]] ?? (pixel >= 0 ? axis.values[pixel] : null);
    });
    if (values.every((value) => value !== null)) {
      this.plane.point = map.y ? values : [values[0], 0.5];
    }
  }

  /** What a pixel says besides its value. */
  #flags({ status, bits }, n) {
    const list = [];
    if (bits?.[n] & 1) list.push("other values are hidden here: zoom in");
    if (bits?.[n] & 2) return ["not read yet"];
    if (bits?.[n] & 4 || status?.[n] === 255) return ["not computed yet"];
    for (const { mask, name } of this.map.flags ?? []) if (status?.[n] & mask) list.push(name);
    return list;
  }

  /** Moves to the cell nearest to a point; by a key at least to the next one in that direction. */
  move(point, byKey) {
    const { map } = this.state;
    const { plane } = this.plane;
    const index = plane && this.plane.indexAt(point);
    if (!index) return this.plane.point;
    [map.x, map.y].forEach((name, i) => {
      const axis = this.#axis(name);
      if (!axis) return;
      const before = map.at[name];
      let next = plane.axes[i].index?.[index[i]] ?? before;
      const way = point[i] - (this.plane.point?.[i] ?? point[i]);
      const far = Math.abs(way) > 1e-8 * Math.abs(axis.to - axis.from);
      if (byKey && far && next === before) next += Math.sign(way) * Math.sign(axis.to - axis.from);
      map.at[name] = Math.min(axis.points - 1, Math.max(0, next));
    });
    map.point = [map.at[map.x], map.at[map.y] ?? 0];
    this.#placePoint(plane.axes);
    this.plane.draw();
    return this.plane.point;
  }

  /** Looks closely at the cell. */
  look() {
    if (!this.map) return;
    this.cells.want(this.#at([]));
    this.#askLine();
  }

  #showCell(cell) {
    const names = Object.keys(cell.axes);
    const where = names.map(
      (name) => `${this.#axis(name)?.symbol ?? name} = ${told(cell.axes[name], 9)}`,
    );
    const { point = null, vc = null, motion = null } = cell;
    const unit = this.#axis("tau")?.unit ?? "1";
    this.told.look({ point, vc, motion }, { where: where.join(", "), unit, fixed: true });
    const value = ([name, v]) => [
      name,
      cell.kinds?.[name] ?? (typeof v === "number" ? told(v, 9) : String(v ?? "no value")),
    ];
    const status = cell.computed ? cell.status.join(", ") || "no flags" : "not computed yet";
    terms(element("cell"), [...Object.entries(cell.fields).map(value), ["status", status]]);
  }

  view(view) {
    const { map } = this.state;
    if (view) {
      this.plane.view = view;
      [map.xr, map.yr] = view.map(({ from, to }) =>
        [from, to].map((x) => Number(x.toPrecision(9))),
      );
    } else {
      this.#setView(null, null);
      Object.assign(map, { xr: null, yr: null });
    }
    this.plane.draw();
    this.#ask();
  }

  #askLine() {
    const { map } = this.state;
    const axis = this.#axis(map.slice);
    if (!axis || axis.points < 2) return;
    const w = Math.min(MOST_PIXELS, axis.points, Math.max(100, element("slice").clientWidth));
    this.lines.want({ field: map.field, x: axis.name, at: this.#at([axis.name]), w, h: 1 });
  }

  #showLine({ x, values, bits, field, complete }) {
    const about = this.map?.fields.find(({ name }) => name === field);
    if (!about) return;
    const axis = this.#axis(x.name);
    const kept = [];
    for (let i = 0; i < values.length; i++)
      if (i === 0 || x.index[i] !== x.index[i - 1]) kept.push(i);
    const rows = kept.map((i) => {
      const there = !(bits?.[i] & 6) && Number.isFinite(values[i]);
      return [x.values[i], there ? values[i] : null];
    });
    rows.sort((p, q) => p[0] - q[0]);
    const target = element("slice");
    const style = getComputedStyle(target);
    const grid = { stroke: style.getPropertyValue("--grid").trim(), width: 1 };
    const ends = (unit) => (unit === "1" ? "" : ` (${unit})`);
    const ink = { stroke: style.color, grid, ticks: grid };
    this.line?.destroy();
    this.line = new window.uPlot(
      {
        width: Math.max(200, target.clientWidth),
        height: LINE_HEIGHT,
        scales: { x: { time: false } },
        axes: [
          { ...ink, label: axis.symbol + ends(axis.unit) },
          { ...ink, label: (about.short_name ?? about.name) + ends(about.unit) },
        ],
        series: [
          { label: axis.symbol },
          {
            label: about.short_name ?? about.name,
            width: 1.5,
            stroke: style.getPropertyValue("--calm").trim(),
            spanGaps: false,
            paths: about.storage === "real" ? undefined : window.uPlot.paths.stepped({ align: 0 }),
          },
        ],
      },
      [rows.map(([at]) => at), rows.map(([, value]) => value)],
      target,
    );
    if (!complete) setTimeout(() => this.map && this.#askLine(), 4 * AGAIN);
  }

  name() {
    return (this.map?.name ?? "map").replace(/\.h5$/, "").replace(/[^\w.-]+/g, "_");
  }

  async sweepText() {
    return this.source.sweepText(this.map.id);
  }
}
