// The list of maps in the folder.

import { element, make } from "./dom.js";

/** How often the list is looked at, while the page is seen; in milliseconds. */
const LOOK = 2500;
const WORDS = ["Map", "State", "Axes", "Fields", "Cells", "Changed"];
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

export class MapList {
  /**
   * @param {object} source see source.js
   * @param {{chosen: (id: string) => void,
   *   listed: (maps: object[], folder: string) => void, failed: (error: Error) => void}} told
   */
  constructor(source, told) {
    Object.assign(this, { source, told });
    this.changed = new Map();
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
    const key = JSON.stringify(maps.map((map) => ({ ...map, age_seconds: null })));
    if (key !== this.key) this.#build(maps);
    this.key = key;
    for (const { id, age_seconds: seconds } of maps) {
      const [cell, text] = [this.changed.get(id), age(seconds)];
      if (cell.textContent !== text) cell.textContent = text;
    }
  }

  #build(maps) {
    const head = make("tr", {}, ...WORDS.map((word) => make("th", { scope: "col" }, word)));
    const [table, focused] = [element("maps-table"), document.activeElement?.dataset?.map];
    this.changed.clear();
    const rows = maps.map((map) => this.#row(map));
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
      this.#open(false);
      this.told.chosen(map.id);
    });
    const texts = [
      map.why ? `${state}: ${map.why}` : state,
      axes,
      (map.fields ?? []).join(", "),
      map.cells ? map.cells.toLocaleString("en") : "",
    ];
    const changed = make("td");
    this.changed.set(map.id, changed);
    const cells = texts.map((text) => make("td", {}, text));
    const name = make("th", { scope: "row" }, button);
    return make("tr", { className: map.state }, name, ...cells, changed);
  }
}
