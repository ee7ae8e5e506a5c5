// The sweeps of the queue as a list, each with what can be done with it.

import { count, rate, seconds } from "./amounts.js";
import { element, make } from "./dom.js";

/** @typedef {import("./queue.js").Job} Job */

/** So many of those that are over are listed unless all are asked for. */
const MOST_OVER = 5;
const OVER = ["failed", "done"];
/** What can be done with a sweep in a state, and the label of its button. */
const ACTS = {
  waiting: ["hold", "first", "drop"],
  running: ["hold", "drop"],
  held: ["release", "drop"],
  failed: ["release", "drop"],
  done: [],
};
const LABELS = { hold: "Hold", release: "Release", first: "First", drop: "Drop" };
/** Where the focus goes when a button is gone by what it did. */
const BACK = { hold: "release", release: "hold" };

/** The first line that says why, and the rest. */
function parted(why) {
  const [first, ...rest] = (why ?? "").trim().split("\n");
  return [first.replace(/^[ ×]+/, ""), rest.join("\n").trim()];
}

/** What is to be read of a sweep beyond the line that is always there. */
function restOf({ why, log }) {
  const [, rest] = parted(why);
  // Where it has failed, the end of its log is told already.
  const known = log && rest.includes(log.trim().split("\n").at(-1));
  const parts = [rest, known ? "" : log?.trim()].filter(Boolean);
  return parts.join("\n\n") || "There is nothing yet.";
}

/** How far a sweep is, and what it waits for, in words. @param {Job} job */
function progressOf(job) {
  const parts = [];
  const { cells, cells_done: done, cells_per_second: speed, seconds_left: left, shards } = job;
  if (cells && done !== null) {
    parts.push(`${((100 * done) / cells).toFixed(1)} % of ${count(cells)} cells`);
  }
  if (speed !== null) parts.push(rate(speed));
  if (left !== null) parts.push(`${seconds(left)} left`);
  if (shards.length > 1) {
    const running = shards.filter((shard) => shard.running).length;
    parts.push(`${running} of ${shards.length} shards run`);
  }
  if (job.host) parts.push(`on ${job.host}`);
  if (job.state === "waiting") {
    parts.push(job.place === 0 ? "the next" : `${job.place} before it`);
  }
  if (job.state === "done") parts.push("its map is complete");
  return parts.join(", ");
}

class Row {
  /** Whether it asks whether it is to be dropped. */
  asks = false;
  /** What the name and the buttons were made of. @type {string | null} */
  key = null;
  /** Why, as it is shown. @type {string | null} */
  reason = null;
  /** @type {Job} */
  job;
  mayChange = false;

  /** @param {string} name @param {JobsList} list */
  constructor(name, list) {
    this.name = name;
    this.list = list;
    this.tag = make("span", { className: "tag" });
    this.title = make("h3", { tabIndex: -1 });
    this.told = make("span", { className: "amount" });
    const bar = make("progress", { "aria-label": `Progress of ${name}` });
    this.bar = /** @type {HTMLProgressElement} */ (bar);
    this.why = make("div", { className: "why" });
    this.tools = make("div", { className: "tools", role: "group", "aria-label": name });
    const head = make("div", { className: "head" }, this.tag, this.title, this.told);
    this.item = make("li", {}, head, this.bar, this.why, this.tools);
    this.item.dataset.job = name;
    this.item.addEventListener("keydown", ({ key }) => key === "Escape" && this.#keep());
  }

  /** @param {Job} job @param {boolean} mayChange */
  show(job, mayChange) {
    [this.job, this.mayChange] = [job, mayChange];
    this.item.className = `job ${job.state}`;
    const put = (part, text) => part.textContent !== text && (part.textContent = text);
    put(this.tag, job.state);
    put(this.told, progressOf(job));
    const begun = job.cells !== null && job.cells_done !== null && job.state !== "done";
    this.bar.hidden = !begun;
    if (begun) [this.bar.max, this.bar.value] = [job.cells, job.cells_done];
    this.#showWhy();
    const key = JSON.stringify([job.state, job.map_id, job.place === 0, this.#begun(), mayChange]);
    if (key !== this.key) this.#build();
    this.key = key;
  }

  #begun() {
    return Boolean(this.job.cells_done);
  }

  /** Tells why, and offers the rest and the log of what runs. */
  #showWhy() {
    const { why, state } = this.job;
    const key = JSON.stringify([why, state]);
    if (key === this.reason) return;
    this.reason = key;
    const [first, rest] = parted(why);
    if (rest || state === "running") {
      const label = `More about ${this.name}`;
      const text = make("pre", { tabIndex: 0, role: "region", "aria-label": label });
      const part = make("details", {}, make("summary", {}, first || "Log"), text);
      part.addEventListener("toggle", () => this.#read(part, text));
      this.why.replaceChildren(part);
    } else {
      this.why.replaceChildren(...(first ? [make("p", {}, first)] : []));
    }
  }

  /** The list has only the beginning of it. */
  async #read(part, text) {
    if (!part.hasAttribute("open")) return;
    text.textContent = "…";
    const told = await this.list.told.read(this.name);
    text.textContent = told ? restOf(told) : parted(this.job.why)[1];
  }

  /** Makes the name and the buttons anew. What has the focus keeps it, as far as it is there. */
  #build() {
    const on = /** @type {HTMLElement} */ (document.activeElement);
    const focused = this.item.contains(on) ? on : null;
    const { job } = this;
    if (job.state !== this.state) this.asks = false;
    this.state = job.state;
    if (job.map_id) {
      const open = make("button", { type: "button", className: "link" }, this.name);
      open.title = "Opens its map";
      open.addEventListener("click", () => this.list.told.opened(job.map_id));
      this.title.replaceChildren(open);
    } else {
      this.title.replaceChildren(this.name);
    }
    this.tools.replaceChildren(...(this.asks ? this.#question() : this.#buttons()));
    this.tools.hidden = this.tools.childElementCount === 0;
    if (focused && !this.item.contains(document.activeElement)) this.focus(focused.dataset.act);
  }

  #buttons() {
    if (!this.mayChange) return [];
    const acts = ACTS[this.job.state].filter((act) => act !== "first" || this.job.place !== 0);
    return acts.map((act) =>
      this.#button(act, LABELS[act], () => {
        if (act === "drop") this.#ask();
        else this.list.told.act(this.name, act);
      }),
    );
  }

  #button(act, text, click) {
    const button = make("button", { type: "button" }, text);
    button.dataset.act = act;
    button.setAttribute("aria-label", `${text} ${this.name}`);
    button.addEventListener("click", click);
    return button;
  }

  /** Before a sweep is dropped, it is asked whether that is meant. */
  #question() {
    const box = make("input", { type: "checkbox" });
    const tiles = /** @type {HTMLInputElement} */ (box);
    const also = make("label", {}, tiles, " and what is computed of its map");
    const running = this.job.state === "running";
    return [
      make("span", {}, running ? "It stops, its sweep goes." : "Its sweep goes."),
      ...(this.#begun() && !running ? [also] : []),
      this.#button("drop", "Drop it", () =>
        this.list.told.act(this.name, tiles.checked ? "drop-all" : "drop"),
      ),
      this.#button("keep", "Keep it", () => this.#keep()),
    ];
  }

  #ask() {
    this.asks = true;
    this.#build();
    this.focus("keep");
  }

  #keep() {
    if (!this.asks) return;
    this.asks = false;
    this.#build();
    this.focus("drop");
  }

  /** Moves the focus to a button, to the one that undoes it, or to the name. */
  focus(act) {
    const buttons = [...this.item.querySelectorAll("button")];
    const find = (which) => which && buttons.find(({ dataset }) => dataset.act === which);
    const name = this.title.querySelector("button") ?? this.title;
    (find(act) ?? find(BACK[act]) ?? name).focus();
  }
}

export class JobsList {
  /** @type {Job[]} */
  jobs = [];
  mayChange = false;
  /** Whether all that are over are listed. */
  all = false;
  /** @type {Map<string, Row>} */
  rows = new Map();

  /**
   * @param {{opened: (map: string) => void, act: (name: string, act: string) => void,
   *   read: (name: string) => Promise<{why: string | null, log: string} | null>}} told
   */
  constructor(told) {
    this.told = told;
    element("jobs-all").addEventListener("click", () => {
      this.all = true;
      this.show(this.jobs, this.mayChange);
      element("queue-title").focus();
    });
  }

  /** @param {Job[]} jobs @param {boolean} mayChange */
  show(jobs, mayChange) {
    [this.jobs, this.mayChange] = [jobs, mayChange];
    const list = element("jobs");
    const active = /** @type {HTMLElement} */ (document.activeElement);
    const on = list.contains(active) ? active : null;
    const listed = this.all ? jobs : jobs.filter((job) => this.#isListed(job));
    const left = jobs.length - listed.length;
    element("jobs-all").hidden = left === 0;
    element("jobs-all").textContent = `${count(left)} more that are over`;
    element("jobs-none").hidden = jobs.length > 0;
    const names = new Set(listed.map(({ name }) => name));
    const gone = [...this.rows.keys()].filter((name) => !names.has(name));
    for (const name of gone) {
      this.rows.get(name)?.item.remove();
      this.rows.delete(name);
    }
    let next = list.firstElementChild;
    for (const job of listed) {
      const row = this.rows.get(job.name) ?? new Row(job.name, this);
      this.rows.set(job.name, row);
      row.show(job, mayChange);
      if (row.item === next) next = next.nextElementSibling;
      else list.insertBefore(row.item, next);
    }
    // What was moved on the page has lost the focus.
    if (on?.isConnected && on !== document.activeElement && !list.contains(document.activeElement))
      on.focus();
  }

  /** Of those that are over, the last are listed. */
  #isListed(job) {
    if (!OVER.includes(job.state)) return true;
    const same = this.jobs.filter(({ state }) => state === job.state);
    return same.length - same.indexOf(job) <= MOST_OVER;
  }

  /** Moves the focus to a sweep, or to a button of it. */
  focus(name, act) {
    const row = this.rows.get(name);
    if (row) row.focus(act);
    else element("queue-title").focus();
  }

  /** The sweep behind one, or before it if it is the last. */
  beside(name) {
    const names = [...element("jobs").querySelectorAll("li")].map(({ dataset }) => dataset.job);
    const at = names.indexOf(name);
    return names[at + 1] ?? names[at - 1];
  }
}
