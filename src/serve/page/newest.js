// Answers to the newest question: older ones are not waited for.

export class Newest {
  /**
   * @param {(question: any, signal: AbortSignal) => Promise<any>} ask
   * @param {(answer: any, question: any) => void} show
   * @param {(error: Error, question: any) => void} fail
   * @param {{most?: number, patience?: number}} limits questions that are under way at once, and
   *   after how many milliseconds one of them is given up for a newer one
   */
  constructor(ask, show, fail, { most = 1, patience = Infinity } = {}) {
    Object.assign(this, { ask, show, fail, most, patience });
    this.underWay = new Map();
    [this.number, this.shown, this.next] = [0, 0, null];
  }

  /** Asks, as soon as there is room; a question that has not been asked yet is forgotten. */
  want(question) {
    this.next = { question };
    this.#go();
  }

  /** Asks nothing more, and drops what is under way: nothing waits for it. */
  stop() {
    clearTimeout(this.later);
    this.next = null;
    for (const number of this.underWay.keys()) this.#drop(number);
  }

  #drop(number) {
    this.underWay.get(number).controller.abort();
    this.underWay.delete(number);
  }

  #go() {
    clearTimeout(this.later);
    if (this.next && this.underWay.size >= this.most) this.#makeRoom();
    while (this.next && this.underWay.size < this.most) {
      const { question } = this.next;
      this.next = null;
      this.#one(++this.number, question);
    }
  }

  /** Gives up the oldest question that is under way, now or once it has had its time. */
  #makeRoom() {
    const [[oldest, { begun }]] = this.underWay;
    const left = begun + this.patience - performance.now();
    if (left <= 0) this.#drop(oldest);
    else if (left < Infinity) this.later = setTimeout(() => this.#go(), left);
  }

  async #one(number, question) {
    const controller = new AbortController();
    this.underWay.set(number, { controller, begun: performance.now() });
    try {
      const answer = await this.ask(question, controller.signal);
      if (number > this.shown && !controller.signal.aborted) {
        this.shown = number;
        for (const other of this.underWay.keys()) if (other < number) this.#drop(other);
        this.show(answer, question);
      }
    } catch (error) {
      if (!controller.signal.aborted && number > this.shown) this.fail(error, question);
    } finally {
      this.underWay.delete(number);
      this.#go();
    }
  }
}
