// The page: what is set, what is shown, and the point that is looked at.

import { tellCell } from "./cells.js";
import { Controls } from "./controls.js";
import { download, element, tellCopied } from "./dom.js";
import { tellLegend } from "./legend.js";
import { Live } from "./live.js";
import { Panel } from "./panel.js";
import { PlaneView } from "./plane.js";
import { ZOOM, follow, zoomed } from "./pointing.js";
import { Saved } from "./saved.js";
import { Scale, told } from "./scale.js";
import { openSource } from "./source.js";
import { addressOf, stateOf } from "./state.js";
import { VALUES, parametersOf, pointTexts } from "./sweep.js";
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

class Explorer {
  constructor(source, catalogue) {
    this.source = source;
    this.catalogue = catalogue;
    this.state = stateOf(location.hash);
    this.plane = new PlaneView(element("chart"));
    const failed = (error) => this.failed(error);
    this.live = new Live(source, catalogue, { shown: (plane) => this.#shown(plane), failed });
    this.panel = new Panel(source, { moved: (start) => this.#started(start), failed });
    this.controls = new Controls(this.state, catalogue, source, {
      changed: () => this.changed(),
      failed,
    });
    this.saved = new Saved(source, this.state, this.plane, {
      shown: (plane) => this.#shown(plane),
      opened: () => this.#mode(),
      look: (texts, about) => this.panel.look(texts, { start: this.state.start, ...about }),
      changed: () => this.#settle(),
      failed,
    });
    this.#listen();
    this.#mode();
    if (source.maps) this.saved.begin();
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
    element("save-toml").title = map ? "The sweep file of this map" : "Run this overnight";
    this.plane.plane = null;
    if (map) {
      this.live.stop();
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
    const usual = [this.state.x, this.state.y].map(({ name }) => VALUES[name]);
    const inside = view.every((scale, i) => scale.part(usual[i]) >= 0 && scale.part(usual[i]) <= 1);
    return inside ? usual : view.map((scale) => scale.value(0.5));
  }

  #ownView() {
    const scale = ({ from, to, log }) => new Scale(from, to, log);
    this.plane.view = [scale(this.state.x), scale(this.state.y)];
  }

  /** What is set has changed. */
  changed() {
    if (this.state.map) return;
    this.#ownView();
    if (!this.state.point) this.plane.point = this.#usualPoint();
    this.live.changed(this.state);
    this.#settle();
  }

  #address() {
    return addressOf(this.state, parametersOf(this.state, this.catalogue.laws));
  }

  /** Address, panel and table follow when nothing changes any more. */
  #settle() {
    clearTimeout(this.settling);
    this.settling = setTimeout(() => {
      history.replaceState(null, "", this.#address());
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
    if (plane.rests) this.#say(this.plane.point);
    if (plane.rests) this.#table();
  }

  #title({ field, axes }) {
    const what = field.short_name ?? field.name;
    const over = axes.map(({ symbol }) => symbol).join(" and ");
    return `${what[0].toUpperCase()}${what.slice(1)} over ${over}`;
  }

  #table() {
    const { plane, view } = this.plane;
    if (plane && view && element("table-part").open) tellTable(element("table"), plane, view);
  }

  /** What the chart shows at a point, in words. */
  #words(point) {
    const { plane } = this.plane;
    const index = point && plane && this.plane.indexAt(point);
    if (!index) return "";
    const n = index[0] * plane.ny + index[1];
    const exact = plane.axes.map((axis, i) => (plane.exact ? axis.values[index[i]] : point[i]));
    const where = plane.axes.map(
      ({ symbol, unit }, i) => `${symbol} = ${told(exact[i], 7)}${unit === "1" ? "" : ` ${unit}`}`,
    );
    const parts = [tellCell(plane, n)];
    const { abscissa } = plane.others ?? {};
    if (abscissa && plane.field.name !== "abscissa")
      parts.push(`spectral abscissa ${told(abscissa[n])}`);
    if (plane.flags) parts.push(...plane.flags(n));
    return `${where.join(", ")}: ${parts.join(", ")}`;
  }

  #say(point) {
    const words = this.#words(point);
    if (words) element("readout").textContent = words;
  }

  /** Looks closely at the point of the chart. */
  look() {
    const { state, plane } = this;
    if (state.map) return this.saved.look();
    try {
      const texts = pointTexts(state, this.catalogue.laws, plane.point);
      const symbol = (axis) => this.catalogue.parameters.find((p) => p.name === axis.name)?.symbol;
      const where = [state.x, state.y].map(
        (axis, i) => `${symbol(axis)} = ${told(plane.point[i], 9)}`,
      );
      const unit = state.units ? state.units.split(",")[2] : "1";
      this.panel.look(texts, { where: where.join(", "), start: state.start, unit });
    } catch (error) {
      this.failed(error);
    }
    return undefined;
  }

  /** Moves the point; by a key, in a map, at least to the next cell. */
  #move(point, byKey) {
    const { state, plane } = this;
    if (state.map) this.saved.move(point, byKey);
    else state.point = plane.point = point.map((x) => Number(x.toPrecision(9)));
    plane.draw();
    this.#say(plane.point);
  }

  #view(view) {
    const { state } = this;
    if (state.map) return this.saved.view(view);
    if (!view) {
      this.#allOfAxes();
    } else {
      for (const [axis, scale] of [
        [state.x, view[0]],
        [state.y, view[1]],
      ])
        this.#setEnds(axis, scale);
    }
    this.controls.tellEnds();
    this.changed();
    this.plane.draw();
    return undefined;
  }

  /** The ends of an axis, with no more digits than the eye tells apart. */
  #setEnds(axis, { from, to }) {
    const digits = (x) => {
      const step = 10 ** (Math.floor(Math.log10(Math.abs(to - from))) - 4);
      return Number((Math.round(x / step) * step).toPrecision(12));
    };
    const never = axis.name === "tau" ? 0 : -Infinity;
    const ends = [Math.max(never, digits(from)), digits(to)];
    if (ends[0] < ends[1] && Number.isFinite(ends[0])) [axis.from, axis.to] = ends;
  }

  #allOfAxes() {
    const { x, y } = this.begun ?? {};
    for (const [axis, was] of [
      [this.state.x, x],
      [this.state.y, y],
    ]) {
      if (was && was.name === axis.name) Object.assign(axis, was);
    }
  }

  #started(start) {
    this.state.start = start;
    this.#settle();
  }

  failed(error) {
    const lost = error instanceof TypeError && /fetch|network|load failed/i.test(error.message);
    if (lost || error.status === NO_TOKEN) return this.#lost(error);
    element("problem").textContent = error.message + (error.help ? ` (${error.help})` : "");
    if (!error.status && !(error instanceof RangeError)) console.error(error);
    return undefined;
  }

  /** The server is gone, or is another one: asks until it answers, then for what is to be seen. */
  #lost(error) {
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
  }

  #alive() {
    clearInterval(this.retrying);
    this.retrying = null;
    element("gone").hidden = true;
  }

  #listen() {
    this.begun = { x: { ...this.state.x }, y: { ...this.state.y } };
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
      hover: (point) => (element("hover").textContent = this.#words(point)),
      view: (view) => this.#view(view),
    });
    const zoom = (factor) =>
      this.plane.view && this.#view(zoomed(this.plane.view, [0.5, 0.5], factor));
    const click = (id, act) => element(id).addEventListener("click", act);
    click("zoom-in", () => zoom(ZOOM));
    click("zoom-out", () => zoom(1 / ZOOM));
    click("zoom-all", () => this.#view(null));
    click("take-law", () => this.controls.takeLaw("weakening"));
    click("to-live", () => {
      this.state.map = null;
      this.#mode();
    });
    this.#downloads(click);
    element("table-part").addEventListener("toggle", () => this.#table());
    window.addEventListener("hashchange", () => {
      if (location.hash === this.#address()) return;
      Object.assign(this.state, stateOf(location.hash));
      this.controls.build();
      this.#mode();
    });
  }

  #downloads(click) {
    const name = () => (this.state.map ? this.saved.name() : "slipmap-chart");
    const { plane } = this;
    const shown = (act) => () => plane.plane && act();
    click(
      "save-png",
      shown(async () => download(`${name()}.png`, await plane.png())),
    );
    click(
      "save-svg",
      shown(() => download(`${name()}.svg`, plane.svg(), "image/svg+xml")),
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
    click("copy-link", async (event) => {
      history.replaceState(null, "", this.#address());
      const button = event.target;
      await navigator.clipboard?.writeText(location.href).catch(() => {});
      tellCopied(button);
    });
  }
}

async function begin() {
  try {
    const source = await openSource();
    const explorer = new Explorer(source, await source.parameters());
    // For tests and the curious.
    window.slipmap = explorer;
  } catch (error) {
    element("problem").textContent = error.message + (error.help ? ` (${error.help})` : "");
    if (!error.status) console.error(error);
  }
}

begin();
