// Answers to the newest question: older ones are not waited for.

export class Newest {
  /**
   * @param {(question: any, signal: AbortSignal) => Promise<any>} ask
   * @param {(answer: any, question: any) => void} show
   * @param {(error: Error, question: any) => void} fail
   * @param {number} most questions that are under way at once
   */
  constructor(ask, show, fail, most = 1) {
    Object.assign(this, { ask, show, fail, most });
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
    this.next = null;
    for (const controller of this.underWay.values()) controller.abort();
    this.underWay.clear();
  }

  #go() {
    while (this.next && this.underWay.size < this.most) {
      const { question } = this.next;
      this.next = null;
      this.#one(++this.number, question);
    }
  }

  async #one(number, question) {
    const controller = new AbortController();
    this.underWay.set(number, controller);
    try {
      const answer = await this.ask(question, controller.signal);
      if (number > this.shown && !controller.signal.aborted) {
        this.shown = number;
        for (const [other, old] of this.underWay) if (other < number) old.abort();
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
