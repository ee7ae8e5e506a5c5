// Steps back and forth through what was set: those of the browser's own history.

import { element } from "./dom.js";

/** Changes that follow one another as closely as this are one step, in milliseconds. */
const CLOSE = 1000;

export class Steps {
  /** @param {() => void} settle puts what has not come to rest yet */
  constructor(settle) {
    this.settle = settle;
    // A page that is opened anew does not know what lies ahead.
    this.step = this.last = history.state?.step ?? 0;
    [this.put_, this.given] = [-Infinity, true];
    element("undo").addEventListener("click", () => this.back());
    element("redo").addEventListener("click", () => history.forward());
    document.addEventListener("keydown", (event) => this.#key(event));
    window.addEventListener("popstate", () => this.#moved());
    this.#tell();
  }

  back() {
    this.settle();
    if (this.step > 0) history.back();
  }

  /** The address has changed by itself: somebody went back or forth, or typed another one. */
  #moved() {
    const { step } = history.state ?? {};
    this.step = step ?? this.step + 1;
    if (step === undefined) {
      this.last = this.step;
      history.replaceState({ step: this.step }, "");
    }
    this.last = Math.max(this.last, this.step);
    this.given = true;
    this.#tell();
  }

  /** What is set has come to rest at an address. */
  put(address) {
    const now = performance.now();
    const other = address !== location.hash;
    // What an address says that was given is no step of its own, however it is written here.
    if (this.given || !other || now - this.put_ < CLOSE) {
      history.replaceState({ step: this.step }, "", address);
    } else {
      this.last = ++this.step;
      history.pushState({ step: this.step }, "", address);
    }
    if (other && !this.given) this.put_ = now;
    this.given = false;
    this.#tell();
  }

  #tell() {
    element("undo").disabled = this.step === 0;
    element("redo").disabled = this.step >= this.last;
  }

  /** Ctrl+Z, except where text is typed. */
  #key(event) {
    const { key, target } = event;
    if (!(event.ctrlKey || event.metaKey) || event.altKey || key.toLowerCase() !== "z") return;
    if (target.matches("textarea, input:not([type=range], [type=radio], [type=checkbox])")) return;
    event.preventDefault();
    if (event.shiftKey) history.forward();
    else this.back();
  }
}
