// The text of a sweep that is handed in: mistakes are told at their place, the plan beside it.

import { bytes, count, seconds } from "./amounts.js";
import { Asked } from "./asked.js";
import { element, input, make, terms } from "./dom.js";
import { Kept } from "./kept.js";
import { partsOf, placeOf } from "./mistake.js";

/** How long nothing is typed before the text is looked at, in milliseconds. */
const REST = 300;
/** Where a text that was not handed in waits for the page, should that be loaded anew. */
const draft = new Kept("slipmap sweep");

export class Editor {
  text = /** @type {HTMLTextAreaElement} */ (element("sweep-text"));
  title = input("sweep-name");
  first = input("sweep-first");
  hold = input("sweep-hold");
  /** Whether a plan is shown. */
  shown = false;
  /** Whether the text was handed in as it is, and whether it is being. */
  sent = false;
  sending = false;
  /** What was there before another text took its place. @type {any} */
  before = null;
  /** Why it was not taken. @type {any} */
  refused = null;

  /**
   * @param {any} source see source.js
   * @param {{lost: (error: Error) => boolean, words: (error: Error) => string,
   *   submitted: (job: object, isNew: boolean) => void}} told
   */
  constructor(source, told) {
    this.source = source;
    this.told = told;
    const heard = (asked) => {
      if (asked.error) asked.lost = told.lost(asked.error);
      this.#tell();
    };
    this.plans = new Asked((text, signal) => source.plan(text, false, signal), heard);
    this.times = new Asked((text, signal) => source.plan(text, true, signal), heard);
    this.#listen();
    const { text = "", title = "", first = false, hold = false } = draft.read() ?? {};
    [this.text.value, this.title.value] = [text, title];
    [this.first.checked, this.hold.checked] = [first, hold];
    this.#tell();
    if (text) this.#ask();
  }

  #listen() {
    this.text.addEventListener("input", () => this.#typed());
    this.text.addEventListener("scroll", () => this.#scroll());
    for (const field of [this.title, this.first, this.hold])
      field.addEventListener("input", () => this.#keep());
    element("sweep-goto").addEventListener("click", () => this.#goTo());
    element("plan-time").addEventListener("click", () => {
      this.times.want(this.#wanted());
      this.#tell();
    });
    element("sweep-back").addEventListener("click", () => {
      const { text, title } = this.before;
      this.before = null;
      this.#set(text, title);
      this.text.focus();
    });
    element("sweep").addEventListener("submit", (event) => {
      event.preventDefault();
      this.#submit();
    });
  }

  /** The text that is to be looked at; null without one. */
  #wanted() {
    return this.text.value.trim() ? this.text.value : null;
  }

  #typed() {
    [this.refused, this.sent] = [null, false];
    this.#keep();
    this.#draw();
    // What was asked of another text is not waited for.
    if (this.plans.text !== this.text.value) {
      this.plans.want(null);
      this.times.want(null);
    }
    this.#tell();
    clearTimeout(this.resting);
    this.resting = setTimeout(() => this.#ask(), REST);
  }

  #ask() {
    clearTimeout(this.resting);
    this.plans.want(this.#wanted());
    this.#tell();
  }

  /** The server is back. */
  again() {
    this.#ask();
  }

  #keep() {
    const [text, title] = [this.text.value, this.title.value];
    const all = { text, title, first: this.first.checked, hold: this.hold.checked };
    draft.write(text || title ? all : null);
  }

  /** Takes a sweep in the place of what is there, which can be taken back. */
  take(text, title) {
    const own = { text: this.text.value, title: this.title.value };
    this.before = own.text.trim() && own.text !== text && !this.sent ? own : null;
    this.#set(text, title);
    element("sweep-told").textContent = "The sweep of the chart is here, to be handed in.";
    this.title.focus();
    this.title.select();
  }

  #set(text, title) {
    [this.text.value, this.title.value] = [text, title];
    this.#typed();
    this.#ask();
  }

  /** What is wrong with the text, as far as that is known. */
  #mistake() {
    const { error, lost, text } = this.plans;
    if (this.refused) return this.refused;
    return error && !lost && text === this.text.value ? error : null;
  }

  /** Tells of the text: the place of a mistake, or its plan. */
  #tell() {
    const mistake = this.#mistake();
    const place = mistake ? placeOf(mistake) : null;
    this.text.setAttribute("aria-invalid", String(mistake !== null));
    const where = place ? `line ${place.line}, column ${place.column}: ` : "";
    const put = (id, words) => {
      if (element(id).textContent !== words) element(id).textContent = words;
    };
    put("sweep-mistake", mistake ? where + mistake.message : "");
    put("sweep-help", mistake?.help ?? "");
    element("sweep-goto").hidden = !place;
    if (place) put("sweep-goto", `To line ${place.line}`);
    element("sweep-back").hidden = !this.before;
    this.#draw();
    this.#tellPlan(put, mistake !== null);
  }

  #tellPlan(put, wrong) {
    const { answer: plan } = this.plans;
    const former = !plan && !wrong && this.shown;
    element("plan-part").classList.toggle("asking", former);
    input("plan-time").disabled = !plan;
    if (wrong || this.#wanted() === null) {
      this.shown = false;
      terms(element("plan"), []);
      put("plan-remarks", "");
      put("plan-none", wrong ? "The text has no plan as it is." : "What it takes is told here.");
    }
    if (plan) {
      this.shown = true;
      put("plan-none", "");
      const { bytes_needed: needed, bytes_free: free, threads } = plan;
      const lacks = free !== null && needed > free;
      const room = free === null ? "" : `, ${bytes(free)} are free`;
      const on = `on ${threads} thread${threads === 1 ? "" : "s"}`;
      terms(element("plan"), [
        ["cells", count(plan.cells)],
        ["pieces", count(plan.pieces)],
        ["disk", `at most ${bytes(needed)} while it is made${room}${lacks ? ": too few" : ""}`],
        ["memory", `at most ${bytes(plan.memory)} ${on}`],
      ]);
      put("plan-remarks", plan.remarks.map((remark) => `${remark}.`).join(" "));
    }
    const { answer: timed, error, pending: timing, lost } = this.times;
    if (timing) put("plan-timed", "A sample is timed …");
    else if (timed) put("plan-timed", this.#timed(timed));
    else put("plan-timed", error && !lost ? this.told.words(error) : "");
  }

  #timed({ timed, threads }) {
    const [least, about, most] = timed.seconds.map(seconds);
    const soon = timed.seconds[2] < 1;
    const took = soon ? "less than a second" : `about ${about} (${least} to ${most})`;
    const on = `on ${threads} thread${threads === 1 ? "" : "s"}`;
    return `${took} ${on}; its map takes about ${bytes(timed.bytes_on_disk)}`;
  }

  /** Draws the numbers of the lines, and the mark behind the text. */
  #draw() {
    const { value } = this.text;
    const lines = Array.from({ length: value.split("\n").length }, (_, i) => i + 1).join("\n");
    if (element("sweep-lines").textContent !== lines) element("sweep-lines").textContent = lines;
    const mistake = this.#mistake();
    const marks = element("sweep-marks");
    if (mistake?.span && mistake.text === value) {
      const [before, wrong, behind] = partsOf(mistake);
      marks.replaceChildren(before, make("mark", {}, wrong || " "), `${behind}\n`);
    } else {
      marks.replaceChildren();
    }
    this.#scroll();
  }

  #scroll() {
    const { scrollTop, scrollLeft } = this.text;
    Object.assign(element("sweep-marks"), { scrollTop, scrollLeft });
    element("sweep-lines").scrollTop = scrollTop;
  }

  #goTo() {
    const mistake = this.#mistake();
    if (!mistake) return;
    const [before, wrong] = partsOf(mistake);
    this.text.focus();
    this.text.setSelectionRange(before.length, before.length + wrong.length);
  }

  async #submit() {
    if (this.sending) return;
    const text = this.#wanted();
    element("sweep-told").textContent = text ? "" : "There is nothing to hand in yet.";
    if (!text) {
      this.text.focus();
      return;
    }
    this.sending = true;
    const [first, hold] = [this.first.checked, this.hold.checked];
    const options = { name: this.title.value.trim(), first, hold };
    try {
      const { job, isNew } = await this.source.submit(text, options);
      if (this.text.value === text) {
        draft.write(null);
        [this.before, this.sent] = [null, true];
        this.first.checked = this.hold.checked = false;
      }
      this.#tell();
      this.told.submitted(job, isNew);
    } catch (error) {
      if (this.told.lost(error)) return;
      // A mistake is told at its place, everything else beside the button.
      if (error.span) {
        this.refused = error;
        this.text.focus();
      } else {
        element("sweep-told").textContent = this.told.words(error);
      }
      this.#tell();
    } finally {
      this.sending = false;
    }
  }
}
