// Says where a picture is not of what is set.

import { element } from "./dom.js";

/** How long a picture may lag behind, in milliseconds. */
const LAG = 200;
const FORMER = "The picture is of the former values; the one of what is set is not there yet.";
const NONE = "The picture is not there yet.";

export class Stale {
  /** When what is not shown yet was asked for, by its number, the oldest first. */
  #since = new Map();
  #number = 0;

  /** @param {import("./plane.js").PlaneView} plane */
  constructor(plane) {
    this.plane = plane;
  }

  /** Something else is asked for; its number. */
  ask() {
    this.#since.set(++this.#number, performance.now());
    this.#tell();
    return this.#number;
  }

  /** What has this number is shown now, and with it all that was asked before. */
  show(number) {
    for (const other of this.#since.keys()) if (other <= number) this.#since.delete(other);
    this.#tell();
  }

  /** What is asked for does not come. */
  fail() {
    for (const number of this.#since.keys()) this.#since.set(number, -Infinity);
    this.#tell();
  }

  /** Nothing is asked for any more. */
  clear() {
    this.show(this.#number);
  }

  /** Says so once the oldest has lasted, and takes it back when that is shown. */
  #tell() {
    clearTimeout(this.timer);
    const [oldest] = this.#since.values();
    const left = oldest === undefined ? Infinity : oldest + LAG - performance.now();
    const lags = left <= 0;
    const words = lags ? (this.plane.plane ? FORMER : NONE) : "";
    const told = element("stale");
    if (told.textContent !== words) told.textContent = words;
    this.plane.canvas.classList.toggle("stale", lags);
    if (!lags && oldest !== undefined) this.timer = setTimeout(() => this.#tell(), left);
  }
}
