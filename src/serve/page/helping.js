// What the page offers beside the chart: the stable region, the best setting, and two settings
// beside one another.

import { element, make } from "./dom.js";
import { bestIn, isSearched, stableRegion } from "./region.js";
import { told, withUnit } from "./scale.js";
import { Waiting } from "./waiting.js";

/** The lists of answers that are compared. */
const COMPARED = ["point", "intervals", "vc", "outcome"];

export class Helping {
  /**
   * @param {object} source see source.js
   * @param {object} state see state.js
   * @param {import("./catalogue.js").Catalogue} catalogue
   * @param {import("./plane.js").PlaneView} plane
   * @param {{shows: (ends: [number, number][], point: number[]) => void,
   *   takes: (point: number[]) => void, unit: (dimension: number[]) => string,
   *   where: () => string, at: () => number[] | null, address: () => string | null,
   *   compares: () => void, failed: (error: Error) => void}} done
   */
  constructor(source, state, catalogue, plane, done) {
    Object.assign(this, { source, state, catalogue, plane, ...done });
    this.waiting = new Waiting(element("helping-waiting"), "The search", {
      stop: () => this.asking?.abort(),
      again: () => this.asked?.(),
    });
    const click = (id, act) => element(id).addEventListener("click", act);
    click("fit", () => this.fit());
    click("where-stable", () => {
      // The button goes once something stable is in view.
      element("chart-title").focus();
      this.fit();
    });
    click("best", () => this.best());
    click("compare", () => {
      if (this.kept) this.forget();
      else this.keep(this.address());
      this.compares();
    });
  }

  /** What was asked for is not wanted any more, and what was found is of something else. */
  clear() {
    this.stop();
    if (!this.plane.best) return;
    this.plane.best = null;
    element("best-told").replaceChildren();
    this.plane.draw();
  }

  stop() {
    this.asking?.abort();
    this.waiting.ends();
  }

  /** The chart that is shown now, at rest. */
  shown({ counts }) {
    const none = Boolean(counts) && !this.state.map && !counts.includes(0);
    element("nothing").hidden = !none;
    element("best").hidden = Boolean(this.state.map) || !isSearched(this.state);
    element("fit").hidden = Boolean(this.state.map);
  }

  /** One search at a time. */
  async #ask(again, search) {
    this.stop();
    this.asked = again;
    this.asking = new AbortController();
    const { signal } = this.asking;
    this.waiting.goesOn("search");
    try {
      const found = await search(signal);
      if (!signal.aborted) this.waiting.ends();
      return signal.aborted ? undefined : found;
    } catch (error) {
      if (!signal.aborted) {
        this.waiting.ends();
        this.failed(error);
      }
      return undefined;
    }
  }

  /** Shows the stable region. */
  async fit() {
    const { state, catalogue, source } = this;
    const found = await this.#ask(
      () => this.fit(),
      (signal) => stableRegion(state, catalogue, source, this.plane.point, signal),
    );
    if (found === null) this.failed(new RangeError("nothing is stable, as far as one looks"));
    if (found) this.shows(found.ends, found.centre);
  }

  /** Marks the best setting in view, and offers it. */
  async best() {
    const { state, catalogue, source, plane } = this;
    const found = await this.#ask(
      () => this.best(),
      (signal) => bestIn(state, catalogue, source, signal),
    );
    if (!found) return;
    const gainFirst = state.x.name !== "tau";
    const placed = ({ tau, ...of }) => {
      const gain = of.alpha ?? of.value;
      return gainFirst ? [gain, tau] : [tau, gain];
    };
    const { best, robust } = found;
    const box = robust && placed(robust).map((x, i) => this.#off(x, robust.spreads, i, gainFirst));
    plane.best = { point: placed(best), box };
    plane.draw();
    this.#tellBest(found, placed);
  }

  /** The ends of what a robust setting stands along an axis. */
  #off(x, [gain, delay], axis, gainFirst) {
    const part = (axis === 0) === gainFirst ? gain : delay;
    return [x * (1 - part), x * (1 + part)];
  }

  #tellBest({ best, robust }, placed) {
    const time = (relaxation) =>
      relaxation > 0
        ? `settles in ${withUnit(told(relaxation, 4), this.unit([0, 0, 1]))}`
        : "is not stable";
    const offer = (words, point, then) => {
      const button = make("button", { type: "button" }, words);
      button.addEventListener("click", () => this.takes(point));
      return make("p", {}, button, " ", then);
    };
    const proof = ({ certified }) => (certified ? "" : "; not certified");
    const settles = time(best.relaxation_time) + proof(best);
    const rows = [offer("Take the best", placed(best), settles)];
    if (robust) {
      const off = told(100 * robust.spread, 3);
      const worst = `${time(robust.worst_relaxation_time)} where all is off by up to ${off} %`;
      rows.push(offer("Take the robust one", placed(robust), worst + proof(robust)));
    }
    element("best-told").replaceChildren(...rows);
  }

  /** Keeps the answers that are shown, to stand beside the next ones; `address` is that of them. */
  keep(address) {
    this.#compare({ where: this.where(), rows: this.#rows() }, address);
  }

  /** Compares nothing any more. */
  forget() {
    this.#compare(null, null);
  }

  #compare(kept, address) {
    [this.kept, this.state.compared] = [kept, address];
    const at = kept && this.at();
    this.plane.other = at && { at, of: [this.state.x.name, this.state.y.name] };
    element("compare").setAttribute("aria-pressed", String(Boolean(kept)));
    this.plane.draw();
    this.tell();
  }

  /** What the cards say now. */
  #rows() {
    const rows = new Map();
    for (const id of COMPARED) {
      // What is hidden is of another point.
      if (element(id).closest("[hidden]")) continue;
      for (const row of element(id).children) {
        const [term, text] = [...row.children].map((part) => part.textContent);
        rows.set(term, text);
      }
    }
    return rows;
  }

  /** The answers are others now. */
  tell() {
    const table = element("compared");
    element("compared-part").hidden = !this.kept;
    if (!this.kept) {
      table.replaceChildren();
      return;
    }
    const now = { where: this.where(), rows: this.#rows() };
    const terms = [...new Set([...this.kept.rows.keys(), ...now.rows.keys()])];
    const head = ["Answer", `A: ${this.kept.where}`, `B: ${now.where}`];
    const row = (term) => {
      const texts = [this.kept, now].map(({ rows }) => rows.get(term) ?? "–");
      const cells = texts.map((text) => make("td", {}, text));
      const className = texts[0] === texts[1] ? "" : "other";
      return make("tr", { className }, make("th", { scope: "row" }, term), ...cells);
    };
    const columns = head.map((text) => make("th", { scope: "col" }, text));
    table.replaceChildren(
      make("thead", {}, make("tr", {}, ...columns)),
      make("tbody", {}, ...terms.map(row)),
    );
  }
}
