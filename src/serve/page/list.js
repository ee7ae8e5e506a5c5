// The list of maps in the folder: each with a small picture of it, found by words of its own.

import { bytes, seconds } from "./amounts.js";
import { element, make } from "./dom.js";
import { Thumbnails } from "./thumbnails.js";
import { contentsOf } from "./trace.js";

/** How often the list is looked at, while the page is seen; in milliseconds. */
const LOOK = 2500;
const WORDS = ["Map", "State", "Axes", "Fields", "Size", "Changed"];
const AGES = [
  [86400, "day"],
  [3600, "hour"],
  [60, "minute"],
  [1, "second"],
];

/** How long ago, in words. */
function age(seconds) {
  if (seconds === undefined) return "";
  const [size, word] = AGES.find(([s]) => seconds >= s) ?? [1, "second"];
  const count = Math.max(0, Math.floor(seconds / size));
  return `${count} ${word}${count === 1 ? "" : "s"} ago`;
}

/** Whether all words of a search are in what is said of a map. */
function isFound({ name, title, fields = [], axes = [] }, words) {
  const said = [name, title ?? "", ...fields, ...axes.flatMap((axis) => [axis.name, axis.symbol])];
  const text = said.join("\n").toLowerCase();
  return words.every((word) => text.includes(word));
}

export class MapList {
  /**
   * @param {object} source see source.js
   * @param {{chosen: (id: string) => void,
   *   listed: (maps: object[], folder: string) => void, failed: (error: Error) => void}} told
   */
  constructor(source, told) {
    Object.assign(this, { source, told, maps: [] });
    /** What changes in a row as time goes by, by the id of its map. */
    this.rows = new Map();
    this.thumbnails = new Thumbnails(source);
    this.search = make("input", { type: "search", id: "maps-search" });
    this.search.addEventListener("input", () => this.#filter());
    this.none = make("p", { role: "status" });
    const label = make("label", { className: "row" }, "Search ", this.search);
    element("maps-title").after(label, this.none);
    element("to-maps").addEventListener("click", () => this.#open(element("maps").hidden));
  }

  /** Looks at the list, again and again. */
  async begin() {
    if (document.visibilityState === "visible") await this.look();
    setTimeout(() => this.begin(), LOOK);
  }

  async look() {
    try {
      const { folder, maps } = await this.source.maps();
      element("to-maps").hidden = maps.length === 0;
      element("to-maps").textContent = `Maps (${maps.length})`;
      element("maps-title").textContent = `Maps in ${folder}`;
      this.#tell(maps);
      this.told.listed(maps, folder);
    } catch (error) {
      // A folder that was not given is no mistake.
      if (error.status !== 404) this.told.failed(error);
    }
  }

  #open(open) {
    element("maps").hidden = !open;
    element("to-maps").setAttribute("aria-expanded", String(open));
  }

  #tell(maps) {
    const lasting = ({ age_seconds: _, seconds_left: __, ...map }) => map;
    const key = JSON.stringify(maps.map(lasting));
    this.maps = maps;
    if (key !== this.key) this.#build();
    this.key = key;
    for (const map of maps) {
      const { changed, left } = this.rows.get(map.id);
      const words = map.seconds_left === null ? "" : `, ${seconds(map.seconds_left)} left`;
      for (const [cell, text] of [
        [changed, age(map.age_seconds)],
        [left, words],
      ]) {
        if (cell.textContent !== text) cell.textContent = text;
      }
    }
  }

  #build() {
    const head = make("tr", {}, ...WORDS.map((word) => make("th", { scope: "col" }, word)));
    const [table, focused] = [element("maps-table"), document.activeElement?.dataset?.map];
    this.rows.clear();
    const rows = this.maps.map((map) => this.#row(map));
    table.replaceChildren(make("thead", {}, head), make("tbody", {}, ...rows));
    this.thumbnails.keep(this.maps);
    this.#filter();
    if (focused) table.querySelector(`[data-map="${focused}"]`)?.focus();
  }

  /** Shows the maps of which the words of the search are said. */
  #filter() {
    const words = this.search.value.toLowerCase().split(/\s+/).filter(Boolean);
    let count = 0;
    for (const map of this.maps) {
      const found = isFound(map, words);
      this.rows.get(map.id).row.hidden = !found;
      count += Number(found);
    }
    const { length } = this.maps;
    this.none.textContent = words.length > 0 ? `${count} of ${length} maps` : "";
  }

  #row(map) {
    const axes = (map.axes ?? []).map(({ symbol, points }) => `${symbol} (${points})`).join(" × ");
    const button = make("button", { type: "button", className: "link" }, map.name);
    button.dataset.map = map.id;
    button.disabled = !(map.axes ?? []).length && !map.trace;
    button.addEventListener("click", () => {
      this.#open(false);
      this.told.chosen(map.id);
    });
    const title = make("span", { className: "title" }, map.title ?? "");
    const named = make("span", { className: "named" }, button, title);
    const thumbnail = this.thumbnails.of(map);
    const name = make("th", { scope: "row" }, make("span", { className: "map" }, thumbnail, named));
    const [changed, left] = [make("td"), make("span")];
    const cells = map.cells ? `${map.cells.toLocaleString("en")} cells` : "";
    const size = make("td", {}, cells, make("span", { className: "bytes" }, bytes(map.bytes)));
    const told = map.trace
      ? [contentsOf(map.trace), map.trace.outcome]
      : [axes, (map.fields ?? []).join(", ")];
    const others = told.map((text) => make("td", {}, text));
    const state = make("td", {}, ...this.#state(map), left);
    const row = make("tr", { className: map.state }, name, state, ...others, size, changed);
    this.rows.set(map.id, { row, changed, left });
    return row;
  }

  /** The state of a map in words, and how far it is. */
  #state({ name, state: of, why, cells, cells_done: done, trace }) {
    const state = trace ? "trace" : of;
    if (!["running", "interrupted"].includes(state)) return [why ? `${state}: ${why}` : state];
    const share = cells ? Math.floor((100 * done) / cells) : 0;
    const bar = make("progress", { max: cells || 1, value: done ?? 0, "aria-label": name });
    return [bar, `${state}, ${share} %`];
  }
}
