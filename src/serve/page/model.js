// The model of the live chart: the block, a system of the program, or one from a text.

import { FILE } from "./catalogue.js";
import { element, make } from "./dom.js";
import { textOf } from "./file.js";
import { partsOf, placeOf } from "./mistake.js";

/** What the block is called. */
const BLOCK = "a block on its spring";
const FROM_TEXT = "a system from a text or a file";
/** What the page cannot show, though it is a system. */
const TOO_FEW = "A chart needs two parameters: give the system one besides its delay.";

/**
 * Asks for what there is in a system, unless that is known.
 * @param {import("./catalogue.js").Catalogue} catalogue
 * @param {object} source
 * @param {string} text
 * @param {AbortSignal} [signal]
 * @throws what is not understood of it, with its place in the text
 */
export async function learnSystem(catalogue, source, text, signal) {
  if (catalogue.texts.has(text)) return;
  const system = await source.system(text, signal);
  const offered = system.own.filter(({ page }) => page);
  if (offered.length + system.others.length < 2) throw new RangeError(TOO_FEW);
  catalogue.texts.set(text, system);
}

/** The line of a mistake with its place marked. */
function marked(mistake) {
  const [before, wrong, behind] = partsOf(mistake);
  const begun = before.slice(before.lastIndexOf("\n") + 1);
  const [here] = wrong.split("\n");
  const [rest] = here === wrong ? behind.split("\n") : [""];
  return make("code", {}, begun, make("u", {}, here || " "), rest);
}

export class ModelChoice {
  /**
   * @param {object} state see state.js; what is set is written there
   * @param {import("./catalogue.js").Catalogue} catalogue
   * @param {object} source
   * @param {{mended: () => void, failed: (error: Error) => void,
   *   words: (error: Error) => string}} done of: a model with its parameters, an error
   */
  constructor(state, catalogue, source, done) {
    Object.assign(this, { state, catalogue, source, done });
    const option = (value, text) => make("option", { value }, text);
    const known = catalogue.systems.map(({ name, title }) => option(name, title || name));
    element("model").append(option("", BLOCK), ...known, option(FILE, FROM_TEXT));
    element("model").addEventListener("change", (event) => this.#take(event.target.value));
    element("system-text").addEventListener("input", (event) => this.#read(event.target.value));
    element("system-file").addEventListener("change", (event) => this.#open(event.target));
  }

  /** Another model. A text begins with the system that was chosen last. */
  #take(model) {
    const { state, catalogue } = this;
    if (model === FILE && !state.system) {
      state.system = (catalogue.system(state) ?? catalogue.systems[0]).toml;
    }
    state.model = model;
    this.#set();
  }

  /** Sets what the model leaves open, and tells that it is another one. */
  #set() {
    const { state, catalogue } = this;
    if (!catalogue.shown(state).includes(state.show)) [state.show] = catalogue.shown(state);
    this.#dropValues();
    this.done.mended();
  }

  /** Values of before that another text does not allow are left. */
  #dropValues() {
    const { state, catalogue } = this;
    if (!state.model) return;
    for (const name of catalogue.ofSystem(state)) {
      const [low, high] = catalogue.about(name).range;
      const value = state.values[name];
      if (value < low || value > high) delete state.values[name];
    }
    for (const key of ["x", "y"]) {
      const axis = state[key];
      const own = catalogue.ofSystem(state).includes(axis.name);
      // What is no axis of it is mended in any case.
      if (own && catalogue.wrong(axis)) axis.name = "";
    }
  }

  async #open(chooser) {
    const [file] = chooser.files;
    if (!file) return;
    // The same file may be chosen again, when it has changed.
    chooser.value = "";
    try {
      const text = await textOf(file);
      element("system-text").value = text;
      await this.#read(text);
    } catch (error) {
      error.message = `${file.name}: ${error.message}`;
      this.#tellMistake(error);
    }
  }

  /** Takes a text: its parameters get sliders, and a mistake is told below it. */
  async #read(text) {
    const { state } = this;
    this.reading?.abort();
    this.asked = text;
    this.reading = new AbortController();
    const { signal } = this.reading;
    let mistake = null;
    try {
      await learnSystem(this.catalogue, this.source, text, signal);
      if (!signal.aborted) state.known = text;
    } catch (error) {
      mistake = error;
    }
    if (signal.aborted) return;
    if (mistake && !mistake.status && !(mistake instanceof RangeError)) {
      this.done.failed(mistake);
      return;
    }
    state.system = text;
    if (mistake) this.refused = text;
    this.#tellMistake(mistake);
    this.#set();
  }

  #tellMistake(mistake) {
    element("system-text").setAttribute("aria-invalid", String(mistake !== null));
    const place = element("system-mistake");
    place.replaceChildren();
    if (mistake === null) return;
    const at = placeOf(mistake);
    if (at) place.append(`line ${at.line}: `, marked(mistake), " ");
    place.append(this.done.words(mistake));
  }

  /** Shows what is set. The text of a view that is not known is asked about again. */
  build() {
    const { state, catalogue } = this;
    const { model } = state;
    element("model").value = model;
    for (const id of ["control-part", "law-fields"]) {
      element(id).hidden = model !== "";
    }
    element("model-told").textContent = catalogue.system(state)?.text ?? "";
    element("system-input").hidden = model !== FILE;
    const shown = catalogue.shown(state);
    for (const option of element("show").options) {
      option.hidden = option.disabled = !shown.includes(option.value);
    }
    // A text that is still read is not what is set any more.
    if (state.system !== this.asked) this.reading?.abort();
    if (model !== FILE) return;
    const text = element("system-text");
    if (text.value !== state.system) text.value = state.system;
    if (catalogue.texts.has(state.system)) {
      state.known = state.system;
      this.#tellMistake(null);
    } else if (this.refused !== state.system) {
      this.refused = state.system;
      this.#read(state.system);
    }
  }
}
