// Notices of the browser about sweeps that end, once they are asked for.

import { element } from "./dom.js";

/** @typedef {import("./queue.js").Job} Job */

const ENDED = { done: "is done", failed: "has failed" };

export class Notices {
  /** The names of sweeps that were seen to wait or run. @type {Set<string>} */
  #awaited = new Set();
  #on = false;

  /** @param {(job: Job) => void} open what a click on a notice does */
  constructor(open) {
    this.open = open;
    const button = element("notices");
    // Only browsers that trust the connection have notices.
    button.hidden = !("Notification" in window) || !window.isSecureContext;
    button.addEventListener("click", () => this.#ask());
  }

  /** Whether a sweep is awaited of which a notice will tell. */
  get awaits() {
    return this.#on && this.#awaited.size > 0;
  }

  async #ask() {
    const allowed = this.#on || (await Notification.requestPermission()) === "granted";
    this.#on = allowed && !this.#on;
    element("notices").setAttribute("aria-pressed", String(this.#on));
    element("notices-told").textContent = allowed
      ? ""
      : "The browser does not allow notices of this page: its settings do.";
  }

  /**
   * Looks at the list; what has ended since it was seen to wait or run.
   * @param {Job[]} jobs
   * @returns {string[]} in words
   */
  look(jobs) {
    const ended = jobs.filter(({ name, state }) => state in ENDED && this.#awaited.has(name));
    const awaited = jobs.filter(({ name, state }) => {
      const held = state === "held" && this.#awaited.has(name);
      return state === "waiting" || state === "running" || held;
    });
    this.#awaited = new Set(awaited.map(({ name }) => name));
    return ended.map((job) => {
      const words = `${job.name} ${ENDED[job.state]}`;
      if (this.#on) this.#notify(job, words);
      return words;
    });
  }

  /** @param {Job} job @param {string} words */
  #notify(job, words) {
    const body = job.state === "failed" ? (job.why ?? "").split("\n")[0] : "Its map is complete.";
    const notice = new Notification(words, { body, tag: `slipmap ${job.name}` });
    notice.onclick = () => {
      window.focus();
      notice.close();
      this.open(job);
    };
  }
}
