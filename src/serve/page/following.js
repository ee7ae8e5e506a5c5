// The answers at the side follow the pointer: one question at a time, of where it is by then.

/** How long an answer is waited for before the next question, in milliseconds. */
const PATIENCE = 300;

export class Following {
  /**
   * @param {{pending: boolean}} panel see panel.js
   * @param {(point: number[] | null) => void} look asks about a point; null: the marked one again
   */
  constructor(panel, look) {
    Object.assign(this, { panel, look });
    [this.next, this.follows] = [undefined, false];
  }

  /** The pointer is at a point, or has left. */
  to(point) {
    if (point === null && !this.follows && this.next === undefined) return;
    this.next = point;
    this.#go();
  }

  /** The answers are shown, as far as they are there. */
  heard() {
    if (this.next !== undefined) this.#go();
  }

  /** What is looked at by itself is not of the pointer any more. */
  stop() {
    clearTimeout(this.later);
    [this.next, this.follows] = [undefined, false];
  }

  #go() {
    clearTimeout(this.later);
    const { next: point } = this;
    if (point === undefined) return;
    const left = this.begun + PATIENCE - performance.now();
    if (this.follows && this.panel.pending && left > 0) {
      this.later = setTimeout(() => this.#go(), left);
      return;
    }
    this.next = undefined;
    [this.follows, this.begun] = [point !== null, performance.now()];
    this.look(point);
  }
}
