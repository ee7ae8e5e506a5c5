// The form of the live chart: control, axes, parameters, friction law, units.

import { SHOWN, UNITS, unitsOf, withoutZero } from "./catalogue.js";
import { element, make } from "./dom.js";
import { learn, parted } from "./formula.js";
import { buildLimits } from "./limits.js";
import { ModelChoice } from "./model.js";
import { drawLaw } from "./plots.js";
import { told, unitOf, withUnit } from "./scale.js";
import { parametersOf, pointTexts } from "./sweep.js";

const STEPS = 1000;
/** What is said of a measured law: the inputs, and where the state has them. */
const TABLE_INPUTS = [
  ["law-table", "table"],
  ["law-columns", "columns"],
  ["law-speed-unit", "speedUnit"],
];

export class Controls {
  /**
   * @param {object} state see state.js; what is set is written there
   * @param {import("./catalogue.js").Catalogue} catalogue
   * @param {object} source
   * @param {{changed: () => void, failed: (error: Error) => void,
   *   words: (error: Error) => string}} done
   */
  constructor(state, catalogue, source, done) {
    Object.assign(this, { state, catalogue, source, ...done });
    const mended = () => this.#mendAxes();
    this.model = new ModelChoice(state, catalogue, source, { ...done, mended });
    this.#fill();
    this.#listen();
    this.build();
  }

  #fill() {
    const { laws, fields } = this.catalogue;
    const option = (value, text) => make("option", { value }, text);
    const known = fields.filter(({ name }) => SHOWN.includes(name));
    element("show").append(
      ...known.map(({ name, short_name: text }) => option(name, text ?? name)),
    );
    const named = laws.map(({ name }) => option(name, name));
    element("law").append(option("none", "only its slope μ′"), ...named);
    element("units").append(...Object.entries(UNITS).map(([units, text]) => option(units, text)));
  }

  #listen() {
    const { state } = this;
    element("live").addEventListener("submit", (event) => event.preventDefault());
    for (const radio of document.querySelectorAll("input[name=control]")) {
      radio.addEventListener("change", () => this.#control(radio.value));
    }
    element("show").addEventListener("change", (event) => {
      state.show = event.target.value;
      this.changed();
    });
    element("law").addEventListener("change", (event) => this.takeLaw(event.target.value));
    element("law-formula").addEventListener("input", (event) => this.#read(event.target.value));
    for (const [id, key] of TABLE_INPUTS) {
      element(id).addEventListener("input", (event) => {
        state[key] = event.target.value;
        this.changed();
        this.#tellLaw();
      });
    }
    element("units").addEventListener("change", (event) => {
      state.units = event.target.value;
      this.changed();
      this.#tellLaw();
    });
  }

  /** Another control: its gain takes the place of the other one's. */
  #control(control) {
    this.state.control = control;
    this.#mendAxes();
  }

  /** Sets the friction law. */
  takeLaw(law) {
    this.state.law = law;
    this.#mendAxes();
  }

  /** Takes a formula: its parameters get sliders, and a mistake is told beside it. */
  async #read(formula) {
    const { state } = this;
    this.reading?.abort();
    this.reading = new AbortController();
    const { signal } = this.reading;
    let mistake = null;
    try {
      await learn(this.catalogue, this.source, formula, signal);
      if (!signal.aborted) state.understood = formula;
    } catch (error) {
      mistake = error;
    }
    if (signal.aborted) return;
    if (mistake && !mistake.status) {
      this.failed(mistake);
      return;
    }
    state.formula = formula;
    if (mistake) this.refused = formula;
    this.#tellMistake(mistake);
    this.#mendAxes();
  }

  #tellMistake(mistake) {
    element("law-formula").setAttribute("aria-invalid", String(mistake !== null));
    const place = element("formula-mistake");
    place.replaceChildren();
    if (mistake === null) return;
    if (mistake.text) {
      const [before, wrong, behind] = parted(mistake);
      place.append(make("code", {}, before, make("u", {}, wrong), behind), " ");
    }
    place.append(this.words(mistake));
  }

  #mendAxes() {
    const { state, catalogue } = this;
    const names = parametersOf(state, catalogue);
    if (catalogue.mendAxes(state, names, state.highest)) state.point = null;
    this.build();
    this.changed();
  }

  /** Makes the form anew from what is set. What has the focus keeps it. */
  build() {
    const { state } = this;
    const focused = document.activeElement?.id;
    for (const radio of document.querySelectorAll("input[name=control]")) {
      radio.checked = radio.value === state.control;
    }
    [element("show").value, element("law").value] = [state.show, state.law];
    element("units").value = state.units;
    this.model.build();
    for (const [id, key] of TABLE_INPUTS) element(id).value = state[key];
    this.#showFormula();
    const names = parametersOf(state, this.catalogue);
    const free = names.filter((name) => name !== state.x.name && name !== state.y.name);
    const sliders = (list) => list.map((name) => this.#slider(name));
    const first = free.filter((name) => !this.catalogue.about(name).page.folded);
    element("sliders").replaceChildren(...sliders(first));
    for (const box of ["feedback", "model"]) {
      const these = free.filter((name) => this.catalogue.about(name).page.folded === box);
      element(`${box}-sliders`).replaceChildren(...sliders(these));
      const none = state.model !== "" && these.length === 0;
      element(`${box}-sliders`).closest("details").hidden = none;
    }
    buildLimits(state, this.catalogue, (name) => this.#slider(name), () => {
      this.build();
      this.changed();
    });
    const legend = element("axes").querySelector("legend");
    const axes = [
      ["Across", "x", "y"],
      ["Upwards", "y", "x"],
    ];
    element("axes").replaceChildren(legend, ...axes.map((axis) => this.#axis(names, ...axis)));
    if (focused && document.activeElement?.id !== focused) element(focused)?.focus();
    this.#tellLaw();
  }

  /** Shows the formula of the view. One whose parameters are not known is asked for again. */
  #showFormula() {
    const { state, catalogue } = this;
    const input = element("law-formula");
    if (input.value !== state.formula) input.value = state.formula;
    if (catalogue.formulas.has(state.formula)) {
      state.understood = state.formula;
      this.#tellMistake(null);
    } else if (state.law === "formula" && this.refused !== state.formula) {
      this.refused = state.formula;
      this.#read(state.formula);
    }
  }

  /** The text of a parameter: its symbol, and what it is. */
  #text(name) {
    const { symbol, long_name: text } = this.catalogue.about(name);
    return `${symbol}, ${text}`;
  }

  #slider(name) {
    const { state } = this;
    const text = this.#text(name);
    const at = this.catalogue.value(state, name);
    const [low, high] = this.catalogue.about(name).page.slider;
    const label = make("label", { htmlFor: `p-${name}` }, text);
    const range = make("input", {
      type: "range",
      id: `p-${name}`,
      min: Math.min(low, at),
      max: Math.max(high, at),
      step: (high - low) / STEPS,
    });
    const number = make("input", {
      type: "number",
      id: `n-${name}`,
      step: "any",
      "aria-label": `${text}, typed`,
    });
    [range.value, number.value] = [at, at];
    for (const input of [range, number]) {
      input.addEventListener("input", () => {
        const value =
          input === range ? Number(input.valueAsNumber.toPrecision(6)) : input.valueAsNumber;
        if (!Number.isFinite(value)) return;
        state.values[name] = value;
        for (const other of [range, number]) if (other !== input) other.value = value;
        this.changed();
        this.#tellLaw();
      });
    }
    return make("div", { className: "slider" }, label, range, number);
  }

  /** The part of the form of an axis of the state, `key`, with the other one at `beside`. */
  #axis(names, title, key, beside) {
    const { state, catalogue } = this;
    const [axis, other] = [state[key], state[beside]];
    const choice = make("select", {
      id: `axis-${key}`,
      "aria-label": `${title}: which parameter`,
    });
    const free = names.filter((name) => name !== other.name);
    const option = (name) => make("option", { value: name }, catalogue.about(name).symbol);
    choice.append(...free.map(option));
    choice.value = axis.name;
    choice.addEventListener("change", () => {
      state[key] = catalogue.axis(choice.value, state, other, state.highest);
      state.point = null;
      this.build();
      this.changed();
    });
    const mistake = make("p", { className: "mistake", role: "status" });
    const end = (which, word) => {
      const input = make("input", {
        type: "number",
        id: `axis-${key}-${which}`,
        step: "any",
        value: axis[which],
        "aria-label": `${title}, ${word}`,
      });
      input.dataset.end = which;
      input.addEventListener("change", () => {
        const wrong = catalogue.wrong({ ...axis, [which]: input.valueAsNumber });
        const told = wrong && `${word} ${input.value || "nothing"}: ${wrong}`;
        mistake.textContent = told ? `${told}; ${axis[which]} stays` : "";
        input.setAttribute("aria-invalid", String(Boolean(wrong)));
        if (wrong) {
          input.value = axis[which];
        } else {
          axis[which] = input.valueAsNumber;
          this.changed();
        }
      });
      return input;
    };
    const log = make("input", { type: "checkbox", id: `axis-${key}-log`, checked: axis.log });
    log.addEventListener("change", () => {
      axis.log = log.checked;
      if (log.checked) [axis.from, axis.to] = withoutZero([axis.from, axis.to]);
      this.build();
      this.changed();
    });
    const part = make(
      "div",
      { className: "axis" },
      make("span", {}, title),
      choice,
      make("label", {}, log, " logarithmic"),
      end("from", "from"),
      make("span", {}, "to"),
      end("to", "to"),
      mistake,
    );
    part.dataset.axis = key;
    return part;
  }

  /** Writes the ends of the axes, which the pointer has moved. */
  tellEnds() {
    for (const part of element("axes").querySelectorAll(".axis")) {
      const axis = this.state[part.dataset.axis];
      for (const input of part.querySelectorAll("input[type=number]")) {
        if (document.activeElement !== input) input.value = axis[input.dataset.end];
      }
    }
  }

  /** Draws the friction law. */
  async #tellLaw() {
    const { state } = this;
    element("law-part").hidden = state.law === "none" || state.model !== "";
    element("table-input").hidden = state.law !== "table";
    element("formula-input").hidden = state.law !== "formula";
    if (element("law-part").hidden) return;
    const own = "an expression in v; other names in it get sliders";
    const { formula } = this.catalogue.law(state.law) ?? {};
    const told = formula ?? "a measured curve, monotone between its points";
    element("formula").textContent = state.law === "formula" ? own : told;
    this.laws?.abort();
    const moves = this.catalogue.moves(state);
    element("law-curve").closest(".plot").hidden = !moves;
    // A law with a state is no curve.
    if (!moves) element("law-told").textContent = element("law-remarks").textContent = "";
    if (!moves) return;
    if (state.law === "formula" && !this.catalogue.formulas.has(state.formula)) {
      element("law-told").textContent = "";
      return;
    }
    this.laws = new AbortController();
    try {
      const point = [state.x, state.y].map(({ name }) => this.catalogue.value(state, name));
      const { point: text } = pointTexts(state, this.catalogue, point);
      const law = await this.source.law(text, this.laws.signal);
      state.highest = Math.max(0, ...law.points.map(([, mu]) => mu));
      this.#moveInside(law.points);
      drawLaw(element("law-curve"), law);
      element("law-told").textContent = law.at ? this.#lawAt(law.at) : "";
      element("law-remarks").textContent = law.remarks.map((remark) => `${remark}.`).join(" ");
    } catch (error) {
      if (error.name === "AbortError") return;
      element("law-told").textContent = this.words(error);
      element("law-remarks").textContent = "";
    }
  }

  /** A velocity that nobody has chosen is one of those that were measured. */
  #moveInside(points) {
    const { state } = this;
    if (points.length === 0 || state.values.v0 !== undefined) return;
    const speeds = points.map(([v]) => v);
    const v0 = this.catalogue.value(state, "v0");
    if (v0 > Math.min(...speeds) && v0 < Math.max(...speeds)) return;
    state.values.v0 = speeds[Math.floor(speeds.length / 2)];
    this.build();
    this.changed();
  }

  /** What a law is at the working velocity, in words. */
  #lawAt({ v0, mu_k: mu, mu_prime: slope }) {
    const words = (name, value) =>
      withUnit(told(value), unitOf(this.catalogue.about(name).dimension, unitsOf(this.state)));
    return (
      `at v0 = ${words("v0", v0)}: μ_K = ${told(mu)}, ` + `slope μ′ = ${words("mu_prime", slope)}`
    );
  }
}
