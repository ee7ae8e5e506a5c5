// How long something takes by now, with a button that stops it.

import { seconds } from "./amounts.js";
import { make } from "./dom.js";

/** What is there sooner than this is not said to be slow, in milliseconds. */
const SOON = 1000;
const TICK = 200;

export class Waiting {
  /**
   * @param {HTMLElement} place where it is told
   * @param {string} what is computed
   * @param {{stop: () => void, again: () => void}} done
   */
  constructor(place, what, { stop, again }) {
    Object.assign(this, { place, what, stop, again });
    [this.begun, this.key] = [null, null];
  }

  /** It is under way, by what is asked: another question begins anew. */
  goesOn(key) {
    if (this.begun !== null && key === this.key) return;
    this.#clear();
    [this.key, this.begun] = [key, performance.now()];
    this.timer = setInterval(() => this.#tick(), TICK);
  }

  /** What is asked by now is there, or nobody waits any more. */
  ends(key = null) {
    const stays = this.stopped && key === this.key;
    if (!stays && (this.begun !== null || this.stopped)) this.#clear();
  }

  #clear() {
    clearInterval(this.timer);
    [this.begun, this.key, this.stopped, this.words] = [null, null, false, null];
    this.place.replaceChildren();
  }

  #tick() {
    const passed = performance.now() - this.begun;
    if (passed < SOON) return;
    if (!this.words) {
      this.words = make("span");
      const button = make("button", { type: "button" }, "Stop");
      button.addEventListener("click", () => this.#stop());
      this.place.replaceChildren(this.words, " ", button);
    }
    this.words.textContent = `${this.what}: computing for ${seconds(Math.floor(passed / 1000))}`;
  }

  #stop() {
    const { key } = this;
    this.#clear();
    [this.stopped, this.key] = [true, key];
    const button = make("button", { type: "button" }, "Compute it");
    button.addEventListener("click", () => {
      this.#clear();
      // The button is gone then.
      this.place.tabIndex = -1;
      this.place.focus();
      this.again();
    });
    this.place.replaceChildren(`${this.what}: stopped `, button);
    this.stop();
    button.focus();
  }
}
