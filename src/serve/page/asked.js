// What is asked about one text, and what came of it.

import { Newest } from "./newest.js";

/** The status of an answer to who does not have the token. */
const NO_TOKEN = 401;

/** What stands for an answer that was not waited for. */
export const stopped = () => Object.assign(new Error("stopped"), { stopped: true });

export class Asked {
  /** @type {string | null} */
  text = null;
  /** @type {any} */
  answer = null;
  /** @type {any} */
  error = null;
  /** Whether the server is gone. */
  lost = false;

  /**
   * @param {(text: string, signal: AbortSignal) => Promise<any>} ask
   * @param {(asked: Asked) => void} told that there is an answer, or an error
   */
  constructor(ask, told) {
    this.told = told;
    const tried = async (text, signal) => {
      try {
        return { answer: await ask(text, signal) };
      } catch (error) {
        if (error.name === "AbortError") throw error;
        return { error };
      }
    };
    const show = ({ answer = null, error = null }, text) => {
      if (text !== this.text) return;
      [this.answer, this.error] = [answer, error];
      told(this);
    };
    this.requests = new Newest(tried, show, () => {});
  }

  /** Whether there will be an answer. */
  get pending() {
    return this.text !== null && !this.answer && !this.error;
  }

  /** Nobody waits for the answer any more. */
  stop() {
    if (!this.pending) return;
    this.requests.stop();
    this.error = stopped();
    this.told(this);
  }

  /** Asks about the same text anew. */
  again() {
    const { text } = this;
    this.want(null);
    this.want(text);
  }

  /** Asks about a text, unless that is known; about nothing with null. */
  want(text) {
    const { status } = this.error ?? {};
    // What is refused once is refused again; what went wrong may go well.
    const refused =
      this.error?.stopped || (status >= 400 && status < 500 && status !== NO_TOKEN);
    if (text === this.text && (text === null || this.pending || this.answer || refused)) return;
    [this.text, this.answer, this.error, this.lost] = [text, null, null, false];
    this.requests.stop();
    if (text !== null) this.requests.want(text);
  }
}
