// Maps from files: views of one of them.

import { flagsOf } from "./cells.js";
import { coloursOf } from "./colours.js";
import { element, make, terms } from "./dom.js";
import { MapList } from "./list.js";
import { Newest } from "./newest.js";
import { Scale, told, valueAlong } from "./scale.js";
import { Slice } from "./slice.js";
import { Problem } from "./source.js";
import { showsTrace, tellTrace } from "./trace.js";

/** How soon an unfinished view is asked for again, in milliseconds. */
const AGAIN = 60;
/** The most pixels of a window each way. */
const MOST_PIXELS = 2048;
/** In all: more of a field of real numbers is refused. */
const MOST_IN_ALL = 2 ** 21;
/** So many planes' curves are kept. */
const MOST_CURVES = 8;
/** Ends of a view are rounded to this part of its width; it is no narrower than that of its ends. */
const [FINE, NARROWEST] = [1e-8, 1e-11];
/** Less of a view's width is no way at all. */
const NO_WAY = 1e-6;
/** What has no second axis is a strip. */
const STRIP = [0, 1];
const NO_SERVER = {
  detail: "This page has no server: maps from files need `slipmap serve`.",
  status: 404,
};

export class Saved {
  /**
   * @param {object} source
   * @param {object} state
   * @param {import("./plane.js").PlaneView} plane
   * @param {import("./stale.js").Stale} stale
   * @param {{shown: Function, opened: Function, look: Function, changed: Function,
   *   folder: Function, failed: Function}} told
   */
  constructor(source, state, plane, stale, told_) {
    Object.assign(this, { source, state, plane, stale, told: told_ });
    [this.map, this.curves, this.describing, this.remarks] = [null, new Map(), 0, []];
    /** The trace that is shown in the place of a map. */
    this.trace = null;
    this.windows = new Newest(
      (asked, signal) => {
        this.#askCurves(asked);
        return source.window(asked.id, asked.query, signal);
      },
      (answer, asked) => this.#show(answer, asked),
      (error) => this.#failed(error),
    );
    this.cells = new Newest(
      ({ id, at }, signal) => source.cell(id, { at }, signal),
      (cell, asked) => this.#showCell(cell, asked),
      told_.failed,
    );
    this.slice = new Slice(source, told_.failed);
    this.list = new MapList(source, {
      chosen: (id) => this.choose(id),
      listed: (maps, folder) => {
        told_.folder(folder);
        this.#listed(maps);
      },
      failed: told_.failed,
    });
    this.#listen();
  }

  begin() {
    return this.list.begin();
  }

  /** Shows another map. */
  choose(id) {
    this.state.map = { id, at: {} };
    this.told.opened();
    element("chart-title").focus();
  }

  /** A map that has grown is described anew, and one that can be opened again. */
  #listed(maps) {
    const own = maps.find(({ id }) => id === this.state.map?.id);
    if (!(own?.axes?.length || own?.trace) || this.seen === undefined) return;
    const seen = seenOf(own);
    if (seen === this.seen) return;
    this.seen = seen;
    this.#describe();
  }

  #listen() {
    element("map").addEventListener("submit", (event) => event.preventDefault());
    const set = (id, key, read) =>
      element(id).addEventListener("change", (event) => {
        const { map } = this.state;
        if (!this.map) return;
        const before = map[key];
        map[key] = read(event.target);
        this.remarks = [];
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
      if (!this.map) return;
      this.state.map.slice = event.target.value;
      this.#askLine();
      this.told.changed();
    });
  }

  /** Opens the map that the state names. Of another one nothing stays, on the screen or under way. */
  async open() {
    const other = this.map?.id !== this.state.map.id;
    this.#stop();
    [this.range, this.looked, this.toldCell] = [null, null, null];
    this.#blank("Map");
    [this.map, this.trace, this.place, this.plane.view] = [null, null, null, null];
    if (other) element("map").hidden = element("slice-part").hidden = true;
    if (this.source.map) await this.#describe();
    else this.#notOpened(new Problem(NO_SERVER));
  }

  /** No map is looked at any more. */
  close() {
    this.#stop();
    [this.map, this.trace] = [null, null];
    showsTrace(false);
    element("origin").hidden = false;
    if (this.seen !== undefined) this.#blank("Chart");
    this.seen = undefined;
  }

  #stop() {
    this.windows.stop();
    this.cells.stop();
    clearTimeout(this.again);
    this.slice.clear();
    this.describing += 1;
    [this.wanted, this.curves] = [null, new Map()];
  }

  /** Nothing is seen, and nothing is said of what was. */
  #blank(title) {
    this.plane.clear();
    this.stale.clear();
    for (const id of ["speed", "readout", "hover"]) element(id).textContent = "";
    for (const id of ["legend", "table"]) element(id).replaceChildren();
    element("hover").hidden = true;
    delete element("legend").dataset.key;
    element("chart-title").textContent = title;
    element("reading").hidden = true;
  }

  async #describe() {
    const { id } = this.state.map;
    const number = ++this.describing;
    try {
      const map = await this.source.map(id);
      if (number !== this.describing) return;
      if (map.trace) return await this.#openTrace(map, number);
      showsTrace(false);
      const before = this.map;
      [this.map, this.trace] = [map, null];
      this.seen = seenOf(map);
      // Another file may have taken the name.
      const other = before && JSON.stringify(before.axes) !== JSON.stringify(map.axes);
      if (other) [this.range, this.place] = [null, null];
      element("map").hidden = element("slice-part").hidden = element("origin").hidden = false;
      this.#begin();
      this.#build();
      this.#ask();
      this.look(before !== null && !other);
    } catch (error) {
      if (number === this.describing) this.#notOpened(error);
    }
  }

  /** Shows the motion of a trace. */
  async #openTrace(trace, number) {
    const motion = await this.source.stored(trace.id);
    if (number !== this.describing) return;
    this.#stop();
    [this.map, this.trace, this.plane.view, this.seen] = [null, trace, null, seenOf(trace)];
    this.#blank("Trace");
    showsTrace(true);
    element("map").hidden = element("origin").hidden = false;
    tellTrace(trace);
    const texts = { point: null, vc: null, motion: trace.case };
    this.told.look(texts, { where: trace.name, fixed: true, stored: motion });
    this.told.changed();
  }

  #notOpened(error) {
    // Who does not answer may do so later; then everything is asked for anew.
    if (error.status) {
      this.#stop();
      this.trace = null;
      showsTrace(false);
      [this.map, this.plane.view, this.seen] = [null, null, this.seen ?? ""];
      this.#blank("No map");
      terms(element("cell"), []);
      element("map").hidden = element("slice-part").hidden = element("origin").hidden = true;
    }
    this.told.failed(error);
  }

  /** A window that is not there leaves no older one of something else in its place. */
  #failed(error) {
    element("reading").hidden = true;
    this.stale.fail();
    if (this.plane.plane?.of !== this.wanted?.of) this.#blank(this.map?.name ?? "Map");
    this.told.failed(error);
  }

  /** Fills in what the state does not say, and drops what the map does not have. */
  #begin() {
    const { map } = this.state;
    const names = this.map.axes.map(({ name }) => name);
    const fields = this.map.fields.map(({ name }) => name);
    const { first } = this.map;
    if (!fields.includes(map.field)) map.field = first.field;
    const long = this.map.axes.filter(({ points }) => points > 1).map(({ name }) => name);
    if (!names.includes(map.x)) map.x = first.x;
    if (!names.includes(map.y) || map.y === map.x) {
      map.y = [first.y, first.x, ...long, ...names].find((name) => name && name !== map.x) ?? null;
    }
    if (!long.includes(map.slice)) map.slice = long.includes(map.y) ? map.y : (long[0] ?? null);
    const middle = ({ name, points }) => {
      const at = map.at[name];
      return [name, Math.min(points - 1, Number.isInteger(at) ? at : Math.floor(points / 2))];
    };
    map.at = Object.fromEntries(this.map.axes.map(middle));
    if (this.plane.view && this.range) return;
    this.remarks = [];
    for (const key of ["x", "y"]) {
      if (map[`${key}log`] && !this.#logarithm(map[key])) {
        map[`${key}log`] = false;
        if (map[key]) this.remarks.push(`no logarithm of 0: ${this.#axis(map[key]).symbol}`);
      }
    }
    this.#setView();
  }

  #axis(name) {
    return this.map.axes.find((axis) => axis.name === name);
  }

  /** Whether an axis can be logarithmic: none that touches or crosses 0 can. */
  #logarithm(name) {
    const axis = this.#axis(name);
    return Boolean(axis) && axis.from * axis.to > 0;
  }

  /** The scale of a whole axis; of one value, with room around it. */
  #whole(name, log) {
    const axis = this.#axis(name);
    if (!axis) return new Scale(...STRIP);
    const [low, high] = axis.from < axis.to ? [axis.from, axis.to] : [axis.to, axis.from];
    const room = low === high ? Math.abs(low) / 2 || 0.5 : 0;
    return new Scale(low - room, high + room, log);
  }

  /** The view that the state names, or of all there is. */
  #setView() {
    const { map } = this.state;
    this.range = [this.#whole(map.x, map.xlog), this.#whole(map.y, map.ylog)];
    this.plane.view = ["xr", "yr"].map((key, i) => {
      const [whole, pair] = [this.range[i], map[key]];
      if (!pair || !this.#axis(map[key[0]])) return whole;
      const scale = new Scale(...pair, whole.log);
      if (pair[0] < pair[1] && scale.log === whole.log && within(scale, whole)) return scale;
      this.remarks.push(`${key}=${pair} is no part of the axis, all of it is shown`);
      map[key] = null;
      return whole;
    });
  }

  #allInView() {
    Object.assign(this.state.map, { xr: null, yr: null });
    this.#setView();
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
    map.xlog &&= this.#logarithm(map.x);
    map.ylog &&= this.#logarithm(map.y);
    this.#allInView();
  }

  /** Makes the form from the map. What has not changed stays, and keeps the focus. */
  #build() {
    const { map } = this.state;
    element("map-title").textContent = this.map.title || this.map.name;
    const scalars = (this.map.scalars ?? []).filter((parameter) => parameter.told);
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
    const fields = this.map.fields.map((f) => [f.name, f.short_name ?? f.name]);
    const named = ({ name, symbol }) => [name, symbol];
    const axes = this.map.axes.map(named);
    const long = this.map.axes.filter(({ points }) => points > 1).map(named);
    options("field", fields, map.field);
    options("map-x", axes, map.x);
    options("map-y", axes, map.y);
    options("slice-axis", long, map.slice);
    element("map-y-row").hidden = element("y-log-row").hidden = !map.y;
    element("slice-part").hidden = long.length === 0;
    for (const key of ["x", "y"]) {
      const can = this.#logarithm(map[key]);
      const box = element(`${key}-log`);
      [box.checked, box.disabled] = [Boolean(map[`${key}log`]), !can];
      element(`${key}-log-why`).textContent = can ? "" : "– not of an axis with 0";
    }
    this.#buildSliders();
  }

  #buildSliders() {
    const { map } = this.state;
    const part = element("map-sliders");
    const others = this.map.axes.filter(({ name }) => name !== map.x && name !== map.y);
    const key = JSON.stringify(others);
    if (key !== part.dataset.key) part.replaceChildren(...others.map((axis) => this.#slider(axis)));
    part.dataset.key = key;
    for (const { name, values } of others) {
      element(`at-${name}`).value = map.at[name];
      this.#tellSlider(name, values?.[map.at[name]]);
    }
  }

  #slider({ name, symbol, long_name: words, points, values }) {
    const id = `at-${name}`;
    const range = make("input", { type: "range", id, min: 0, max: points - 1, step: 1 });
    const output = make("output", { htmlFor: id });
    output.dataset.axis = name;
    range.addEventListener("input", () => {
      if (!this.map) return;
      this.state.map.at[name] = range.valueAsNumber;
      this.#tellSlider(name, values?.[range.valueAsNumber]);
      this.#ask();
    });
    const label = make("label", { htmlFor: id }, `${symbol}, ${words}`);
    return make("div", { className: "slider" }, label, range, output);
  }

  #tellSlider(name, value) {
    const output = element("map-sliders").querySelector(`output[data-axis="${name}"]`);
    if (output) output.value = value === undefined ? "" : told(value, 7);
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
    // Beyond its ends an axis has no cells.
    const [xs, ys] = this.plane.view.map((scale, i) => within(scale, this.range[i]));
    const share = (scale, i) => {
      const seen = this.plane.view[i];
      return seen.part(scale.to) - seen.part(scale.from);
    };
    const part = Math.min(1, Math.sqrt(MOST_IN_ALL / (w * h)));
    const pixels = (length) => Math.min(MOST_PIXELS, Math.max(1, Math.floor(part * length)));
    const at = this.#at([map.x, map.y]);
    const query = {
      field: map.field,
      x: map.x,
      at,
      w: pixels(w * share(xs, 0)),
      h: pixels(h * share(ys, 1)),
      x0: xs.from,
      x1: xs.to,
      xscale: xs.log ? "log" : "linear",
    };
    if (map.y)
      Object.assign(query, { y: map.y, y0: ys.from, y1: ys.to, yscale: ys.log ? "log" : "linear" });
    else query.h = 1;
    const axes = [map.x, map.y].filter(Boolean).map((name) => this.#axis(name));
    const { id, version } = this.map;
    const of = JSON.stringify([id, map.field, map.x, map.y, at]);
    // A view that was only moved shows what lies where.
    const set = of === this.wanted?.of ? this.wanted.set : this.stale.ask();
    // What an answer is about is told by its question: the state may be another one by then.
    this.wanted = {
      id,
      query,
      axes,
      ends: [xs, ys],
      field: this.map.fields.find(({ name }) => name === map.field),
      flags: this.map.flags ?? [],
      from: this.map.title || this.map.name,
      fixed: this.map.scalars ?? [],
      of,
      set,
      curves: JSON.stringify([id, version, map.x, map.y, at]),
    };
    clearTimeout(this.again);
    this.windows.want(this.wanted);
    this.#askLine();
    this.told.changed();
  }

  /** Asks for the curves of a window's plane, which come on the screen with it or after it. */
  async #askCurves({ id, query: { x, y, at }, curves: key }) {
    const { curves } = this;
    const plane = this.map.curves_plane;
    if (curves.has(key) || !plane?.includes(x) || !plane.includes(y)) return;
    curves.set(key, []);
    if (curves.size > MOST_CURVES) curves.delete(curves.keys().next().value);
    try {
      const answer = await this.source.curves(id, { x, y, at });
      if (this.curves !== curves) return;
      curves.set(key, answer.curves);
      const shown = this.plane.plane;
      if (shown?.curvesOf !== key) return;
      shown.curves = answer.curves;
      this.plane.draw();
    } catch (error) {
      curves.delete(key);
      if (this.curves === curves) this.told.failed(error);
    }
  }

  /**
   * Shows a window. One that is not wanted any more is still shown where it only lies elsewhere on
   * the same axes, while a slider or the view moves on: what is wanted now follows.
   */
  #show(answer, asked) {
    const { map } = this.state;
    const { id, query, axes: planeAxes, field } = asked;
    const same = query.x === map.x && (query.y ?? null) === map.y && query.field === map.field;
    if (this.map?.id !== id || !same) return;
    const newest = asked === this.wanted;
    const axes = planeAxes.map((axis, i) => {
      const { values, index } = i === 0 ? answer.x : answer.y;
      return { ...axis, values, index };
    });
    const { values: cells, status, bits, gaps, shown, damage, complete, progress } = answer;
    const rests = complete && newest;
    const of = { gaps, shown, status, bits, damage, rests };
    const plane = { axes, ends: asked.ends, field, cells, ...of };
    this.place = this.place?.id === id ? this.place : null;
    this.#placePoint(axes);
    this.told.shown(
      Object.assign(plane, {
        of: asked.of,
        curvesOf: asked.curves,
        nx: axes[0].values.length,
        ny: axes[1]?.values.length ?? 1,
        flags: (n) => flagsOf(plane, asked.flags, n),
        flagNames: asked.flags,
        colours: coloursOf(field, shown),
        curves: this.curves.get(asked.curves) ?? [],
        from: asked.from,
        fixed: [...this.#places(answer), ...asked.fixed],
        milliseconds: answer.milliseconds,
        note: this.#note(answer),
      }),
    );
    this.stale.show(asked.set);
    if (asked.of === this.wanted.of) {
      for (const { name, value } of answer.at ?? []) this.#tellSlider(name, value);
    }
    element("reading").hidden = complete;
    element("reading").value = progress;
    if (complete || !newest) return;
    this.again = setTimeout(() => asked === this.wanted && this.windows.want(asked), AGAIN);
  }

  /** Where a window lies along the axes that do not span it. */
  #places({ at = [] }) {
    return at.map(({ name, value }) => {
      const { symbol, unit } = this.#axis(name);
      return { name, symbol, unit, value };
    });
  }

  #note({ damage, complete, progress, milliseconds }) {
    const read = complete
      ? `read in ${milliseconds.toFixed(0)} ms`
      : `reading, ${Math.floor(100 * progress)} %`;
    return [damage ? `damaged: ${damage}` : read, ...this.remarks].join("; ");
  }

  /** The cell of the state, as a point of the plane. */
  #placePoint(axes) {
    const values = axes.map((axis) => this.#valueOn(axis, this.state.map.at[axis.name]));
    const known = values.every((value) => value !== null);
    this.plane.point = known ? [values[0], values[1] ?? (STRIP[0] + STRIP[1]) / 2] : null;
  }

  /** A value of an axis that may have too many to be described, as far as they are on the screen. */
  #valueOn({ name, values, index }, wanted) {
    const { values: all } = this.#axis(name);
    if (all) return all[wanted];
    if (this.place?.at[name] === wanted) return this.place.values[name];
    const [first, last] = [index[0], index[index.length - 1]];
    if (wanted < Math.min(first, last) || wanted > Math.max(first, last)) return null;
    const distance = (pixel) => Math.abs(index[pixel] - wanted);
    let near = 0;
    for (let pixel = 1; pixel < index.length; pixel++) {
      if (distance(pixel) < distance(near)) near = pixel;
    }
    return values[near];
  }

  /** Moves to the cell nearest to a point; by a key at least to the next one in that direction. */
  move(point, byKey) {
    const { map } = this.state;
    const { plane, view } = this.plane;
    const index = this.map && plane && this.plane.indexAt(point);
    if (!index) return this.plane.point;
    plane.axes.forEach((shown, i) => {
      const axis = this.#axis(shown.name);
      const before = map.at[axis.name];
      let next = shown.index[index[i]] ?? before;
      const from = this.plane.point?.[i] ?? point[i];
      const way = view[i].part(point[i]) - view[i].part(from);
      if (byKey && Math.abs(way) > NO_WAY && next === before)
        next += Math.sign(way) * Math.sign(axis.to - axis.from);
      map.at[axis.name] = Math.min(axis.points - 1, Math.max(0, next));
    });
    this.#placePoint(plane.axes);
    this.plane.draw();
    return this.plane.point;
  }

  /**
   * Looks closely at the cell.
   * @param {boolean} again at the one that was looked at last, of which nothing may have changed
   */
  look(again = false) {
    if (!this.map) return;
    if (!again || !this.looked) this.looked = { at: this.#at([]), index: { ...this.state.map.at } };
    this.cells.want({ ...this.looked, id: this.map.id, again });
    this.#askLine();
  }

  #showCell(cell, { id, index, again }) {
    if (this.map?.id !== id) return;
    this.place = { id, at: index, values: cell.axes };
    if (this.plane.plane) {
      this.#placePoint(this.plane.plane.axes);
      this.plane.draw();
    }
    const names = Object.keys(cell.axes);
    const where = names.map((name) => {
      const { symbol = name, speed } = this.#axis(name) ?? {};
      return valueAlong({ symbol, speed }, cell.axes[name], 9);
    });
    const { point = null, vc = null, motion = null } = cell;
    const key = JSON.stringify([where, point, vc, motion]);
    // While a map grows, what is computed at the point stays as it is.
    if (!again || key !== this.toldCell)
      this.told.look({ point, vc, motion }, { where: where.join(", "), fixed: true });
    this.toldCell = key;
    const text = (value) => (typeof value === "number" ? told(value, 9) : (WORDS[value] ?? value));
    const value = ([name, found]) => [name, cell.kinds?.[name] ?? text(found)];
    const status = cell.computed ? cell.status.join(", ") || "no flags" : "not computed yet";
    terms(element("cell"), [...Object.entries(cell.fields).map(value), ["status", status]]);
  }

  /** Shows a part of the axes; without one, all of them. */
  view(view) {
    const { map } = this.state;
    if (!this.map) return;
    this.remarks = [];
    if (view) {
      const ends = view.map((scale, i) => (i === 1 && !map.y ? STRIP : rounded(scale)));
      if (ends.includes(null)) return;
      const scales = ends.map(([from, to], i) => new Scale(from, to, view[i].log));
      if (!scales.every((scale, i) => within(scale, this.range[i]))) return;
      this.plane.view = scales;
      [map.xr, map.yr] = [ends[0], map.y ? ends[1] : null];
    } else {
      Object.assign(map, { xr: null, yr: null });
      this.#setView();
    }
    this.plane.draw();
    this.#ask();
  }

  #askLine() {
    const { map } = this.state;
    const axis = this.#axis(map.slice);
    const field = this.map.fields.find(({ name }) => name === map.field);
    if (axis) this.slice.want(this.map.id, axis, field, this.#at([axis.name]));
  }

  name() {
    return ((this.map ?? this.trace)?.name ?? "map").replace(/\.h5$/, "").replace(/[^\w.-]+/g, "_");
  }

  async sweepText() {
    const { id } = this.map ?? this.trace ?? {};
    if (!id) throw new Problem({ detail: "No map is open.", status: 404 });
    return this.source.sweepText(id);
  }
}

/** What of a map or a trace tells, in the list too, that there is more to be seen. */
const seenOf = ({ trace, cells_done: done, state }) =>
  trace ? JSON.stringify(trace) : `${done} ${state}`;

/** Numbers that JSON has not. */
const WORDS = { inf: "∞", "-inf": "−∞", null: "no value" };

/** Fills a list to choose from, if it is another one than before. */
function options(id, list, value) {
  const select = element(id);
  const key = JSON.stringify(list);
  if (select.dataset.key !== key) {
    select.replaceChildren(...list.map(([name, text]) => make("option", { value: name }, text)));
  }
  select.dataset.key = key;
  select.value = value;
}

/** The part of a scale that lies within another one, if there is one. */
function within(scale, whole) {
  const [from, to] = [Math.max(scale.from, whole.from), Math.min(scale.to, whole.to)];
  return from < to ? new Scale(from, to, scale.log) : null;
}

/** The ends of a view with digits that can be seen; none where it is too narrow for numbers. */
function rounded({ from, to, log }) {
  const size = Math.min(to - from, log ? Math.min(Math.abs(from), Math.abs(to)) : Infinity);
  if (!(to - from > NARROWEST * Math.max(Math.abs(from), Math.abs(to)))) return null;
  const digits = Math.floor(Math.log10(FINE * size));
  const short = (x) => {
    const kept = Math.floor(Math.log10(Math.abs(x))) - digits + 1;
    return kept < 1 ? 0 : Number(x.toPrecision(Math.min(17, kept)));
  };
  const ends = [from, to].map((x) => (x === 0 ? 0 : short(x)));
  return ends[0] < ends[1] && ends.every(Number.isFinite) ? ends : null;
}
