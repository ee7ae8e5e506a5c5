// The queue: what waits for a worker, runs, is held, has failed or is done, and where a sweep is
// handed in.

import { argument } from "./amounts.js";
import { Changes } from "./changes.js";
import { copy, element } from "./dom.js";
import { Editor } from "./editor.js";
import { JobsList } from "./jobs.js";
import { Notices } from "./notices.js";

/**
 * A sweep of the queue.
 * @typedef {object} Job
 * @property {string} name
 * @property {"waiting" | "running" | "held" | "failed" | "done"} state
 * @property {number | null} place how many wait before it
 * @property {string} map
 * @property {string | null} map_id
 * @property {number | null} cells
 * @property {number | null} cells_done
 * @property {number | null} cells_per_second
 * @property {number | null} seconds_left
 * @property {string | null} host
 * @property {number} tries
 * @property {string | null} why
 * @property {{shard: string, running: boolean, cells: number, cells_done: number}[]} shards
 */

/** @typedef {{attended: boolean, may_change: boolean, jobs: Job[]}} Listed */

/** How often a page that is not seen looks for what it is to tell, in milliseconds. */
const UNSEEN = 20_000;
const NOT_THERE = 404;
const CHANGES = { hold: { state: "held" }, release: { state: "waiting" }, first: { first: true } };
const BECAME = { hold: "is held", release: "waits", first: "is the next" };

export class Queue {
  #looking = false;
  #again = false;

  /**
   * @param {any} source see source.js
   * @param {{opened: (map: string) => void, maps: () => void, lost: (error: Error) => boolean,
   *   words: (error: Error) => string}} told of: a map to be opened, maps that have changed, a
   *   server that is gone, an error's words
   */
  constructor(source, told) {
    this.source = source;
    this.told = told;
    /** @type {Listed | null} */
    this.listed = null;
    const opened = (map) => {
      this.#open(false);
      told.opened(map);
    };
    const act = (name, what) => this.#act(name, what);
    const read = (name) => this.#read(name);
    this.list = new JobsList({ opened, act, read });
    this.notices = new Notices((job) => job.map_id && opened(job.map_id));
    this.editor = new Editor(source, {
      ...told,
      submitted: (job, isNew) => this.#submitted(job, isNew),
    });
    const changed = (kind) => (kind === "jobs" ? this.look() : told.maps());
    this.changes = new Changes(source, { changed, broken: () => this.look() });
    element("to-queue").addEventListener("click", () => this.#open(element("queue").hidden));
    element("copy-work").addEventListener("click", ({ target }) =>
      copy(element("work-command").textContent, target),
    );
    document.addEventListener("visibilitychange", () => this.#seen());
  }

  async begin() {
    await this.look();
    // A server without a queue tells of no changes.
    if (!this.none) this.changes.begin();
  }

  /** The server is back. */
  again() {
    if (this.none) return;
    this.changes.again();
    this.look();
    this.editor.again();
  }

  /** Opens the editor with a sweep, to be looked at and handed in. */
  take(text, title) {
    this.#open(true);
    this.editor.take(text, title);
  }

  /** The folder of the queue, as the list of maps tells it. */
  setFolder(folder) {
    const words = `slipmap work ${argument(folder)}`;
    if (element("work-command").textContent !== words) element("work-command").textContent = words;
  }

  #open(open) {
    element("queue").hidden = !open;
    element("to-queue").setAttribute("aria-expanded", String(open));
    if (open) this.#tell();
  }

  /** Looks at the queue; what changes meanwhile is looked at after it. */
  async look() {
    if (this.#looking) {
      this.#again = true;
      return;
    }
    this.#looking = true;
    try {
      do {
        this.#again = false;
        await this.#lookOnce();
      } while (this.#again);
    } finally {
      this.#looking = false;
    }
  }

  async #lookOnce() {
    try {
      this.listed = await this.source.jobs();
      this.none = false;
    } catch (error) {
      if (error.status === NOT_THERE) this.none = true;
      else if (this.told.lost(error)) this.changes.close();
      else this.#trouble(error);
      return;
    }
    const ended = this.notices.look(this.listed.jobs);
    if (ended.length) this.#say(`${ended.join(", ")}.`);
    this.#tell();
  }

  #tell() {
    if (!this.listed) return;
    const { attended, may_change: mayChange, jobs } = this.listed;
    const open = jobs.filter(({ state }) => state === "waiting" || state === "running").length;
    const button = element("to-queue");
    button.hidden = !mayChange && !attended && jobs.length === 0;
    const words = open ? `Queue (${open})` : "Queue";
    if (button.textContent !== words) button.textContent = words;
    element("overnight").hidden = !mayChange || !this.live;
    element("queue-unattended").hidden = attended;
    element("queue-look").hidden = mayChange;
    element("sweep").hidden = !mayChange;
    if (!element("queue").hidden) this.list.show(jobs, mayChange);
  }

  /** Whether the live chart is shown, whose sweep can be handed in. */
  setLive(live) {
    this.live = live;
    this.#tell();
  }

  #say(words) {
    element("queue-told").textContent = words;
    element("queue-problem").textContent = "";
  }

  #trouble(error) {
    element("queue-problem").textContent = this.told.words(error);
    if (!error.status) console.error(error);
  }

  /** All that there is to say of a sweep; null where that is not known. */
  async #read(name) {
    try {
      return await this.source.job(name);
    } catch (error) {
      if (!this.told.lost(error)) this.#trouble(error);
      return null;
    }
  }

  async #act(name, act) {
    const beside = this.list.beside(name);
    let now = name;
    try {
      if (act in CHANGES) {
        ({ name: now } = await this.source.changeJob(name, CHANGES[act]));
        const as = now === name ? "" : `, as ${now}`;
        this.#say(`${name} ${BECAME[act]}${as}.`);
      } else {
        await this.source.dropJob(name, act === "drop-all");
        this.#say(`${name} is dropped.`);
        now = beside;
      }
    } catch (error) {
      if (!this.told.lost(error)) this.#trouble(error);
    }
    await this.#lookNow();
    this.list.focus(now, act === "drop-all" ? "drop" : act);
  }

  /** Looks, and waits until what was under way has been shown too. */
  async #lookNow() {
    while (this.#looking) await new Promise((done) => setTimeout(done, 20));
    await this.look();
  }

  async #submitted(job, isNew) {
    const before = job.place ? `${job.place} before it` : "the next";
    const where = job.state === "waiting" ? `it waits, ${before}` : `it is ${job.state}`;
    const words = isNew ? "Handed in as" : "The same sweep is there already:";
    this.#say(`${words} ${job.name}; ${where}.`);
    await this.#lookNow();
    this.list.focus(job.name);
  }

  /** A page that is not seen has no stream; it looks now and then if it is to tell of something. */
  #seen() {
    clearInterval(this.unseen);
    if (document.visibilityState === "visible" || this.none) return;
    this.unseen = setInterval(() => this.notices.awaits && this.look(), UNSEEN);
  }
}
