// The page: what is set, what is shown, and the point that is looked at.

import { Catalogue, unitsOf, withoutZero } from "./catalogue.js";
import { gapOf, isBeyond, lacking, valueOf } from "./cells.js";
import { Controls } from "./controls.js";
import { copy, download, element } from "./dom.js";
import { Dropped, take } from "./dropped.js";
import { Following } from "./following.js";
import { learn } from "./formula.js";
import { offerHelp } from "./help.js";
import { Helping } from "./helping.js";
import { tellLegend } from "./legend.js";
import { Live } from "./live.js";
import { learnSystem } from "./model.js";
import { Panel, counted } from "./panel.js";
import { PlaneView } from "./plane.js";
import { ZOOM, follow, zoomed } from "./pointing.js";
import { offerPresets } from "./presets.js";
import { Queue } from "./queue.js";
import { Saved } from "./saved.js";
import { Scale, begun, movedInto, roundEnds, told, unitOf, valueAlong, withUnit } from "./scale.js";
import { openSource } from "./source.js";
import { Stale } from "./stale.js";
import { addressOf, comparedOf, leftOut, stateOf, textsOf } from "./state.js";
import { Steps } from "./steps.js";
import { pointTexts } from "./sweep.js";
import { tellTable } from "./table.js";

/** How long after the last change the address and the panel follow, in milliseconds. */
const REST = 200;
/** How often it is tried whether the server is back. */
const RETRY = 1500;
/** The status of an answer to who does not have the token. */
const NO_TOKEN = 401;
const GONE = "The server does not answer. This page goes on when it is back.";
const ANEW =
  "The server was started anew: open the link that it has printed, and this page goes on.";

/** What a point's answer says of the fields of the live chart. */
const ANSWERED = {
  abscissa: ({ abscissa }) => abscissa,
  frequency: ({ frequency }) => frequency,
  delay_margin: ({ delay_margin: margin, delay_margin_kind: kind, delay_margin_sign: sign }) =>
    kind === "infinite" ? sign * Infinity : margin,
  relaxation_time: ({ abscissa }) =>
    abscissa === null ? null : abscissa < 0 ? -1 / abscissa : Infinity,
};

class Explorer {
  /**
   * @param {object} source see source.js
   * @param {Catalogue} catalogue
   */
  constructor(source, catalogue) {
    this.source = source;
    this.catalogue = catalogue;
    this.state = stateOf(this.#first(location.hash), catalogue);
    this.plane = new PlaneView(element("chart"));
    this.stale = new Stale(this.plane);
    const failed = (error) => this.failed(error);
    const words = (error) => this.words(error);
    const shown = (plane) => this.#shown(plane);
    this.live = new Live(source, catalogue, this.stale, { shown, failed });
    this.panel = new Panel(source, {
      moved: (start) => this.#started(start),
      told: () => {
        this.#say();
        this.helping.tell();
        this.following.heard();
        this.#goOn();
      },
      lost: (error) => this.#lost(error),
      words,
    });
    this.controls = new Controls(this.state, catalogue, source, {
      changed: () => this.#set(),
      failed,
      words,
    });
    this.saved = new Saved(source, this.state, this.plane, this.stale, {
      shown,
      opened: () => this.#mode(),
      look: (texts, about) => this.panel.look(texts, { start: this.state.start, ...about }),
      changed: () => this.#settle(),
      folder: (folder) => this.queue?.setFolder(folder),
      failed,
    });
    this.helping = new Helping(source, this.state, catalogue, this.plane, {
      shows: (ends, point) => this.#showEnds(ends, point),
      takes: (point) => this.#take(point),
      unit: (dimension) => this.#unit(dimension),
      where: () => element("point-where").textContent,
      at: () => (this.state.map ? null : this.panel.at),
      // What is no address of its own cannot be a part of one.
      address: () => (this.state.map || leftOut(this.state) ? null : this.#address()),
      compares: () => this.#settle(),
      failed,
    });
    this.following = new Following(this.panel, (point) => this.#glance(point));
    this.steps = new Steps(() => this.settling && this.#put());
    this.dropped = new Dropped(source, {
      curve: (text) => this.#dropCurve(text),
      setting: (given, name) => this.#dropSetting(given, name),
      map: (id) => this.saved.choose(id),
      failed,
    });
    // What is compared stays.
    offerPresets((address) => {
      const { compared } = this.state;
      location.hash = address + (compared ? `&compare=${encodeURIComponent(compared)}` : "");
    });
    if (source.jobs) this.#queue(words);
    this.#listen();
    this.#mode();
    this.#isFirst();
    if (source.maps) this.saved.begin();
    this.queue?.begin();
  }

  #queue(words) {
    this.queue = new Queue(this.source, {
      opened: (id) => this.saved.choose(id),
      maps: () => this.saved.list.look(),
      lost: (error) => this.#lost(error),
      words,
    });
    element("overnight").addEventListener("click", () => {
      const { show, x, y } = this.state;
      try {
        this.queue.take(this.live.text(this.state), `${show} over ${x.name} and ${y.name}`);
      } catch (error) {
        this.failed(error);
      }
    });
  }

  /** Shows the chart or the map that the state names. */
  #mode() {
    const map = this.state.map !== null;
    for (const [id, shown] of [
      ["live", !map],
      ["map", map],
      ["slice-part", map],
    ]) {
      element(id).hidden = !shown;
    }
    element("to-live").setAttribute("aria-pressed", String(!map));
    element("origin").textContent = map ? "from the file" : "computed now";
    element("save-toml").title = map ? "The sweep file of this map" : "That of this chart";
    this.queue?.setLive(!map);
    this.helping.clear();
    element("nothing").hidden = true;
    this.plane.plane = null;
    this.stale.clear();
    if (map) {
      // Nothing is moved or zoomed before the map is there.
      this.plane.view = null;
      this.live.stop();
      this.panel.clear();
      this.saved.open();
    } else {
      this.saved.close();
      this.#ownView();
      this.plane.point = this.state.point ?? this.#usualPoint();
      this.changed();
    }
  }

  /** The point of the letter's Fig. 3(a), where it is in view. */
  #usualPoint() {
    const view = this.plane.view;
    const { state, catalogue } = this;
    const usual = [state.x, state.y].map(({ name }) => catalogue.value({ values: {} }, name));
    const inside = view.every((scale, i) => scale.part(usual[i]) >= 0 && scale.part(usual[i]) <= 1);
    return inside ? usual : view.map((scale) => Number(scale.value(0.5).toPrecision(9)));
  }

  #ownView() {
    const scale = ({ from, to, log }) => new Scale(from, to, log);
    this.plane.view = [scale(this.state.x), scale(this.state.y)];
  }

  /** Something was set in the form. */
  #set() {
    this.#tellNotes([]);
    this.#keepWhole();
    this.changed();
  }

  /** What an address says that there is not. */
  #tellNotes(notes) {
    const begins = "Not everything in this address is understood: ";
    element("address-told").textContent = notes.length ? `${begins}${notes.join("; ")}.` : "";
  }

  /** Remembers axes as they were set: that is what "All" shows, however the view is moved. */
  #keepWhole() {
    this.whole ??= {};
    for (const key of ["x", "y"]) {
      const [axis, seen] = [this.state[key], this.whole[key]];
      const { now, all } = seen ?? {};
      const same = now?.name === axis.name;
      if (same && now.from === axis.from && now.to === axis.to && now.log === axis.log) continue;
      const next = { ...axis };
      if (same && now.log !== axis.log) {
        [next.from, next.to] = axis.log ? withoutZero([all.from, all.to]) : [all.from, all.to];
      }
      this.whole[key] = { now: { ...axis }, all: next };
    }
  }

  /** What is set has changed. */
  changed() {
    if (this.state.map) return;
    this.helping.clear();
    element("readout").classList.add("asking");
    // It is of the former values.
    element("hover").hidden = true;
    this.#ownView();
    if (!this.state.point) this.plane.point = this.#usualPoint();
    this.live.changed(this.state);
    this.#settle();
  }

  #address() {
    return addressOf(this.state, this.catalogue);
  }

  /** Puts the address of what is shown, or of what is still to be opened. */
  #put() {
    this.steps.put(this.after ? this.after.hash : this.#address());
  }

  /** The address to open first: that of the setting that is compared, until it is answered. */
  #first(hash) {
    const compared = comparedOf(hash);
    const known = compared === null || compared === this.state?.compared;
    this.after = known ? null : { hash, compared, table: this.state?.table };
    return known ? hash : compared;
  }

  /** Shows what an address says, unless there is another one by then. */
  async #open(hash, table = this.state.table) {
    const first = this.#first(hash);
    const { after } = this;
    await learnAddress(this.catalogue, this.source, first);
    if (hash !== location.hash || after !== this.after) return;
    const { compared } = this.state;
    Object.assign(this.state, stateOf(first, this.catalogue));
    if (compared && !this.state.compared) this.helping.forget();
    // A table too long for an address is still here.
    if (leftOut({ ...this.state, table })) {
      Object.assign(this.state, { table, notes: [] });
    }
    this.#tellNotes(this.state.notes);
    this.#keepWhole();
    this.controls.build();
    this.#mode();
    this.#isFirst();
  }

  /** What is shown now comes before what an address is about, if that says so. */
  #isFirst() {
    if (!this.after) return;
    this.state.compared = null;
    this.after.first = this.#address();
    element("address-told").textContent = "What is compared is computed first.";
  }

  /** Compares with what is answered now, where an address says so, and opens the address itself. */
  #goOn() {
    const { after, panel, following } = this;
    if (!after || panel.pending || this.settling || following.follows) return;
    this.after = null;
    this.#tellNotes([]);
    if (this.#address() !== after.first) {
      // Another setting was set meanwhile: that stays.
      this.#put();
      return;
    }
    this.helping.keep(after.compared);
    this.#open(after.hash, after.table);
  }

  /** Address, panel and table follow when nothing changes any more. */
  #settle() {
    clearTimeout(this.settling);
    this.settling = setTimeout(() => {
      this.settling = null;
      this.#put();
      if (!this.state.map) this.look();
      this.#table();
    }, REST);
  }

  #shown(plane) {
    element("problem").textContent = "";
    this.#alive();
    this.plane.show(plane);
    tellLegend(element("legend"), plane);
    element("chart-title").textContent = this.#title(plane);
    const cells = (plane.nx * plane.ny).toLocaleString("en");
    const time = `${cells} cells in ${plane.milliseconds.toFixed(1)} ms`;
    element("speed").textContent = plane.note ?? time;
    if (this.pointed) this.#tellPointed();
    if (!plane.rests) {
      // A map that is still read may take long.
      if (this.state.map) this.#table();
      return;
    }
    this.helping.shown(plane);
    // What is asked at the point tells it more exactly, soon.
    if (this.state.map || this.#exact()) this.#say();
    this.#table();
  }

  #title({ field, axes }) {
    const over = axes.map(({ symbol }) => symbol).join(" and ");
    return `${begun(field.short_name ?? field.name)} over ${over}`;
  }

  #table() {
    const { plane, view } = this.plane;
    if (plane && view && element("table-part").open) tellTable(element("table"), plane, view);
  }

  /** What the chart shows at a point, in words: its cell, by the values of the cell itself. */
  #words(point) {
    const { plane } = this.plane;
    const index = point && plane && this.plane.indexAt(point);
    if (!index) return "";
    const n = index[0] * plane.ny + index[1];
    const values = plane.axes.map((axis, i) => axis.values?.[index[i]] ?? point[i]);
    const where = this.#where(plane.axes, isBeyond(plane, n) ? point : values);
    const lack = lacking(plane, n);
    if (lack) return `${where}: ${lack}`;
    const { abscissa } = plane.others ?? {};
    const gap = gapOf(plane, n)?.text;
    const parts = this.#values(plane, valueOf(plane, n), abscissa?.[n], gap);
    // What a cell is said to be is not said twice.
    return `${where}: ${[...new Set([...parts, ...(plane.flags?.(n) ?? [])])].join(", ")}`;
  }

  #where(axes, values) {
    return axes.map((axis, i) => valueAlong(axis, values[i], 7)).join(", ");
  }

  /** The value of a chart's field or why there is none, and the abscissa that goes with it. */
  #values({ field, colours }, value, abscissa, gap) {
    const { name, unit, kinds, short_name: words } = field;
    const parts = gap ? [gap] : [];
    if (Number.isNaN(value)) parts.splice(0, 1, `${words ?? name}: ${gap ?? told(NaN)}`);
    // What is not sure is not called stable.
    else if (name === "n_unstable")
      parts.push(gap || value === null ? counted(value) : colours.name(value));
    else if (kinds) parts.push(colours.name(value));
    else parts.push(`${words ?? name} ${colours.name(value, unit)}`);
    if (abscissa !== undefined && name !== "abscissa") {
      parts.push(withUnit(`spectral abscissa ${told(abscissa)}`, this.#unit([0, 0, -1])));
    }
    return parts;
  }

  #unit(dimension) {
    return unitOf(dimension, unitsOf(this.state));
  }

  /** What is asked at a point; the reason why nothing can be. */
  #asked(point = this.plane.point) {
    try {
      return { texts: pointTexts(this.state, this.catalogue, point) };
    } catch (error) {
      return { error };
    }
  }

  /** What is known of the point of the live chart by its own values. */
  #exact() {
    const { plane } = this.plane;
    const { texts } = this.#asked();
    const answer = texts && this.panel.answerTo(texts.point);
    // It stays known while the answers follow the pointer.
    if (answer) this.known = { text: texts.point, answer };
    const point = texts?.point === this.known?.text ? this.known?.answer : null;
    if (!point || !plane || plane.field.name !== this.state.show) return null;
    const value = plane.field.name === "n_unstable" ? point.n_unstable : this.#answered(point);
    const { text } = this.catalogue.flags.find((flag) => flag.name === "marginal");
    const gap = point.marginal ? text : undefined;
    const parts = this.#values(plane, value, point.abscissa, gap);
    if (point.certified) parts.push("certified");
    return `${this.#where(plane.axes, this.plane.point)}: ${parts.join(", ")}`;
  }

  #answered(point) {
    return ANSWERED[this.state.show](point);
  }

  /** Tells of the point: in the live chart by what the panel says, as soon as that is there. */
  #say() {
    const exact = this.state.map ? null : this.#exact();
    const words = exact ?? this.#words(this.plane.point);
    const readout = element("readout");
    readout.classList.remove("asking");
    if (readout.textContent !== words) {
      readout.textContent = words;
      element("sheet").textContent = words || "At the point";
    }
  }

  /** Looks closely at the point of the chart. */
  look() {
    this.following.stop();
    if (this.state.map) return this.saved.look();
    this.#lookAt(this.plane.point, "At the point");
    return undefined;
  }

  /** Looks at where the pointer is; at the point again where that has left. */
  #glance(point) {
    if (this.state.map) return;
    if (point) this.#lookAt(point.map((x) => Number(x.toPrecision(6))), "At the pointer");
    else this.#lookAt(this.plane.point, "At the point");
  }

  #lookAt(point, title) {
    const { state, catalogue } = this;
    const where = [state.x, state.y].map(({ name }, i) => {
      const { symbol, dimension, unit } = catalogue.about(name);
      const own = unit === "1" ? this.#unit(dimension) : unit;
      return withUnit(`${symbol} = ${told(point[i], 9)}`, own);
    });
    const fixed = catalogue.isGeneral(state);
    const about = { where: where.join(", "), start: state.start, fixed, title, at: point };
    const { texts, error } = this.#asked(point);
    if (error) this.panel.refuse(error, about);
    else this.panel.look(texts, about);
  }

  /** Moves the point; by a key, in a map, at least to the next cell. */
  #move(point, byKey) {
    const { state, plane } = this;
    if (state.map) this.saved.move(point, byKey);
    else state.point = plane.point = point.map((x) => Number(x.toPrecision(9)));
    plane.draw();
    this.#say();
  }

  /** What the chart shows where the pointer rests; returned too. */
  #tellPointed() {
    const card = element("hover");
    const words = this.#words(this.pointed);
    card.textContent = words;
    card.hidden = !words;
    return words;
  }

  /** The card beside the pointer, and the answers at the side. */
  #hover(point, place) {
    const card = element("hover");
    this.pointed = point;
    const words = this.#tellPointed();
    if (place) {
      const { x, w } = this.plane.area();
      card.classList.toggle("left", place.x > x + w / 2);
      card.style.left = `${place.x}px`;
      card.style.top = `${place.y}px`;
    }
    if (!this.state.map && !this.after) this.following.to(words ? point : null);
  }

  #view(view) {
    const { state } = this;
    this.pointed = null;
    element("hover").hidden = true;
    if (state.map) return this.saved.view(view);
    ["x", "y"].forEach((key, i) => {
      if (view) this.#setEnds(state[key], view[i]);
      else Object.assign(state[key], this.whole[key].all);
      this.whole[key].now = { ...state[key] };
    });
    this.#tellNotes([]);
    this.controls.tellEnds();
    this.changed();
    this.plane.draw();
    return undefined;
  }

  /** Takes a measured friction curve. */
  #dropCurve(text) {
    this.#live();
    Object.assign(this.state, { model: "", table: text, columns: "", speedUnit: "" });
    // Forces are divided by the load, which is set there.
    element("model-part").open = true;
    this.controls.takeLaw("table");
  }

  /** Takes over what a file says; what of it is not shown here is told. */
  async #dropSetting(given, name) {
    const { catalogue, source, state } = this;
    if (given.formula !== null) await learn(catalogue, source, given.formula);
    this.#live();
    const notes = take(state, catalogue, given);
    this.plane.point = state.point;
    this.#keepWhole();
    this.controls.build();
    this.changed();
    const title = given.title || name;
    element("address-told").textContent = notes.length ? `${title}: ${notes.join("; ")}.` : "";
  }

  /** Back to the live chart. */
  #live() {
    if (!this.state.map) return;
    this.state.map = null;
    this.#mode();
  }

  /** Shows a part of the plane, with the point there. */
  #showEnds(ends, point) {
    ["x", "y"].forEach((key, i) => {
      const axis = this.state[key];
      const log = axis.log && ends[i][0] * ends[i][1] > 0;
      this.#setEnds(Object.assign(axis, { log }), new Scale(...ends[i], log));
    });
    this.controls.build();
    this.state.point = point.map((x) => Number(x.toPrecision(6)));
    this.plane.point = this.state.point;
    this.#set();
  }

  /** Takes a setting that is offered. */
  #take(point) {
    this.#move(point, false);
    this.look();
    this.#settle();
  }

  /** The ends of an axis, within what there is, and with no more digits than the eye tells apart. */
  #setEnds(axis, scale) {
    const range = this.catalogue.reach(axis);
    const within = (x) => Math.min(range[1], Math.max(range[0], x));
    const [from, to] = roundEnds(movedInto(scale, range)).map(within);
    if (!this.catalogue.wrong({ ...axis, from, to })) Object.assign(axis, { from, to });
  }

  #started(start) {
    this.state.start = start;
    this.#settle();
  }

  /** An error in words. */
  words(error) {
    return error.message + (error.help ? ` (${error.help})` : "");
  }

  /** Tells of an error of the chart or the map. */
  failed(error) {
    if (this.#lost(error)) return;
    element("problem").textContent = this.words(error);
    if (!error.status && !(error instanceof RangeError)) console.error(error);
  }

  /**
   * Whether the server is gone, or is another one. Then it is asked until it answers, and then for
   * what is to be seen.
   */
  #lost(error) {
    const gone = error instanceof TypeError && /fetch|network|load failed/i.test(error.message);
    if (!gone && error.status !== NO_TOKEN) return false;
    const words = error.status ? ANEW : GONE;
    [element("gone").hidden, element("gone").textContent] = [false, words];
    this.retrying ??= setInterval(async () => {
      try {
        await this.source.parameters();
      } catch (again) {
        if (this.retrying) this.#lost(again);
        return;
      }
      this.#alive();
      if (this.state.map) this.saved.open();
      else this.changed();
    }, RETRY);
    return true;
  }

  #alive() {
    element("gone").hidden = true;
    if (!this.retrying) return;
    clearInterval(this.retrying);
    this.retrying = null;
    // What was asked meanwhile is asked again.
    if (this.state.map) this.saved.look();
    else this.look();
    this.queue?.again();
  }

  #listen() {
    this.#keepWhole();
    this.#tellNotes(this.state.notes);
    follow(this.plane, {
      look: (point) => {
        this.#move(point, false);
        this.look();
        this.#settle();
      },
      move: (point) => {
        this.#move(point, true);
        this.#settle();
      },
      hover: (point, place) => this.#hover(point, place),
      view: (view) => this.#view(view),
    });
    const zoom = (factor) =>
      this.plane.view && this.#view(zoomed(this.plane.view, [0.5, 0.5], factor));
    const click = (id, act) => element(id).addEventListener("click", act);
    click("zoom-in", () => zoom(ZOOM));
    click("zoom-out", () => zoom(1 / ZOOM));
    click("zoom-all", () => this.#view(null));
    click("take-law", () => {
      this.controls.takeLaw("weakening");
      // The button is gone then.
      element("motion-title").focus();
    });
    click("to-live", () => this.#live());
    this.#downloads(click);
    element("table-part").addEventListener("toggle", () => this.#table());
    document.querySelector(".skip").addEventListener("click", (event) => {
      // Its hash would take the place of the view's.
      event.preventDefault();
      element("chart-title").focus();
    });
    offerHelp();
    click("sheet", () => {
      const sheet = element("sheet");
      const open = sheet.getAttribute("aria-expanded") !== "true";
      sheet.setAttribute("aria-expanded", String(open));
    });
    window.addEventListener("hashchange", () => {
      if (location.hash !== this.#address()) this.#open(location.hash);
    });
  }

  #downloads(click) {
    const name = () => (this.state.map ? this.saved.name() : "slipmap-chart");
    const { plane } = this;
    const title = () => this.#title(plane.plane);
    const shown = (act) => () => plane.plane && act();
    click(
      "save-png",
      shown(async () => download(`${name()}.png`, await plane.png(title()))),
    );
    click(
      "save-svg",
      shown(() => download(`${name()}.svg`, plane.svg(title()), "image/svg+xml")),
    );
    click(
      "save-csv",
      shown(() => download(`${name()}.csv`, plane.csv(), "text/csv")),
    );
    click("save-toml", async () => {
      try {
        const own = () => this.live.text(this.state);
        const text = this.state.map ? await this.saved.sweepText() : own();
        download(`${name()}.toml`, text, "application/toml");
      } catch (error) {
        this.failed(error);
      }
    });
    click("copy-link", (event) => {
      this.#put();
      const left = leftOut(this.state);
      const words = left ? `Copied, without the ${left}` : "Copied";
      copy(location.href, event.target, words);
    });
  }
}

/** Learns the formula and the system in the address; a mistake is told with the chart. */
async function learnAddress(catalogue, source, hash) {
  const { formula, system } = textsOf(hash);
  if (formula !== null) await learn(catalogue, source, formula).catch(() => {});
  if (system !== null) await learnSystem(catalogue, source, system).catch(() => {});
}

async function begin() {
  try {
    const source = await openSource();
    const catalogue = new Catalogue(await source.parameters());
    await learnAddress(catalogue, source, comparedOf(location.hash) ?? location.hash);
    const explorer = new Explorer(source, catalogue);
    // For tests and the curious.
    window.slipmap = explorer;
  } catch (error) {
    element("problem").textContent = error.message + (error.help ? ` (${error.help})` : "");
    if (!error.status) console.error(error);
  }
}

begin();
