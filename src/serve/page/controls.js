// The form of the live chart: control, axes, parameters, friction law, units.

import { element, make } from "./dom.js";
import { drawLaw } from "./plots.js";
import { MODEL, VALUES, parametersOf, pointTexts } from "./sweep.js";
import { told } from "./scale.js";

/** Ranges of sliders. */
const RANGES = {
  mu_prime: [-0.95, 0.5],
  mu_k: [0.05, 2],
  v0: [0.01, 3],
  mu0: [0.05, 1],
  v_s: [0.02, 4],
  mu_s: [0.1, 2],
  alpha_v: [-3, 3],
  alpha_n: [-10, 10],
  tau: [0, 25],
  mass: [0.1, 10],
  stiffness: [0.1, 10],
  normal_load: [0.1, 10],
};
/** Axes of a chart as they begin. */
const AXES = {
  mu_prime: [-0.95, 0.2],
  mu_k: [0.05, 2],
  v0: [0.02, 2],
  mu0: [0.05, 1],
  v_s: [0.05, 2],
  mu_s: [0.2, 2],
  alpha_v: [-1.6, 0.4],
  alpha_n: [-3, 1],
  tau: [0, 12],
  mass: [0.2, 5],
  stiffness: [0.2, 5],
  normal_load: [0.2, 5],
};
const SHOWN = ["n_unstable", "abscissa", "relaxation_time", "delay_margin", "frequency"];
const STEPS = 1000;

export class Controls {
  /**
   * @param {object} state see state.js; what is set is written there
   * @param {{parameters: object[], laws: object[], fields: object[]}} catalogue
   * @param {object} source
   * @param {{changed: () => void, failed: (error: Error) => void}} done
   */
  constructor(state, catalogue, source, done) {
    Object.assign(this, { state, catalogue, source, ...done });
    this.about = Object.fromEntries(catalogue.parameters.map((p) => [p.name, p]));
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
    element("law-table").addEventListener("input", (event) => {
      state.table = event.target.value;
      this.changed();
      this.#tellLaw();
    });
    element("units").addEventListener("change", (event) => {
      state.units = event.target.value;
      this.changed();
    });
  }

  /** Another control: its gain takes the place of the other one's. */
  #control(control) {
    const { state } = this;
    state.control = control;
    const gain = { velocity: ["alpha_n", "alpha_v"], load: ["alpha_v", "alpha_n"] }[control];
    for (const axis of [state.x, state.y]) {
      if (gain && axis.name === gain[0]) this.#setAxis(axis, gain[1]);
    }
    state.point = null;
    this.build();
    this.changed();
  }

  #setAxis(axis, name) {
    const [from, to] = AXES[name];
    Object.assign(axis, { name, from, to, log: false });
  }

  /** Sets the friction law. */
  takeLaw(law) {
    const { state } = this;
    state.law = law;
    const known = parametersOf(state, this.catalogue.laws);
    const left = (axis) => !known.includes(axis.name) && !axis.name.startsWith("alpha");
    for (const [axis, other] of [
      [state.x, state.y],
      [state.y, state.x],
    ]) {
      if (!left(axis)) continue;
      const gain = state.control === "load" ? "alpha_n" : "alpha_v";
      this.#setAxis(axis, other.name === gain ? "tau" : gain);
      state.point = null;
    }
    this.build();
    this.changed();
  }

  /** Makes the form anew from what is set. */
  build() {
    const { state } = this;
    for (const radio of document.querySelectorAll("input[name=control]")) {
      radio.checked = radio.value === state.control;
    }
    [element("show").value, element("law").value] = [state.show, state.law];
    [element("units").value, element("law-table").value] = [state.units, state.table];
    const names = parametersOf(state, this.catalogue.laws);
    const free = names.filter((name) => name !== state.x.name && name !== state.y.name);
    const sliders = (list) => list.map((name) => this.#slider(name));
    const first = free.filter((name) => !MODEL.includes(name) && name !== "mu_k");
    element("sliders").replaceChildren(...sliders(first));
    const others = free.filter((name) => MODEL.includes(name) || name === "mu_k");
    element("model-sliders").replaceChildren(...sliders(others));
    const legend = element("axes").querySelector("legend");
    const axes = [
      ["Across", state.x, state.y],
      ["Upwards", state.y, state.x],
    ];
    element("axes").replaceChildren(legend, ...axes.map((axis) => this.#axis(names, ...axis)));
    this.#tellLaw();
  }

  /** The text of a parameter: its symbol, and what it is. */
  #text(name) {
    const { symbol, long_name: text } = this.about[name] ?? { symbol: name, long_name: name };
    return `${symbol}, ${text}`;
  }

  #slider(name) {
    const { state } = this;
    const text = this.#text(name);
    const at = state.values[name] ?? VALUES[name];
    const [low, high] = RANGES[name];
    const label = make("label", { htmlFor: `p-${name}` }, text);
    const range = make("input", {
      type: "range",
      id: `p-${name}`,
      min: Math.min(low, at),
      max: Math.max(high, at),
      step: (high - low) / STEPS,
    });
    const number = make("input", { type: "number", step: "any", "aria-label": `${text}, typed` });
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

  #axis(names, title, axis, other) {
    const choice = make("select", { "aria-label": `${title}: which parameter` });
    const free = names.filter((name) => name !== other.name);
    const option = (name) => make("option", { value: name }, this.about[name]?.symbol ?? name);
    choice.append(...free.map(option));
    choice.value = axis.name;
    choice.addEventListener("change", () => {
      this.#setAxis(axis, choice.value);
      this.state.point = null;
      this.build();
      this.changed();
    });
    const end = (key, word) => {
      const input = make("input", {
        type: "number",
        step: "any",
        value: axis[key],
        "aria-label": `${title}, ${word}`,
      });
      input.dataset.end = key;
      input.addEventListener("change", () => {
        const ends = { ...axis, [key]: input.valueAsNumber };
        if (Number.isFinite(ends[key]) && ends.from < ends.to) {
          axis[key] = ends[key];
          this.changed();
        } else {
          this.failed(new RangeError(`${title}: from must be less than to`));
          input.value = axis[key];
        }
      });
      return input;
    };
    const log = make("input", { type: "checkbox", checked: axis.log });
    log.addEventListener("change", () => {
      if (log.checked && !(axis.from * axis.to > 0)) {
        const far = Math.max(Math.abs(axis.from), Math.abs(axis.to));
        [axis.from, axis.to] = axis.to > 0 ? [far / 1000, far] : [-far, -far / 1000];
      }
      axis.log = log.checked;
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
    );
    part.dataset.axis = axis === this.state.x ? "x" : "y";
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
    element("law-part").hidden = state.law === "none";
    element("table-input").hidden = state.law !== "table";
    if (state.law === "none") return;
    const { formula } = this.catalogue.laws.find(({ name }) => name === state.law) ?? {};
    element("formula").textContent = formula ?? "a measured curve, monotone between its points";
    this.laws?.abort();
    this.laws = new AbortController();
    try {
      const point = [state.x, state.y].map(({ name }) => state.values[name] ?? VALUES[name]);
      const law = await this.source.law(
        pointTexts(state, this.catalogue.laws, point).point,
        this.laws.signal,
      );
      drawLaw(element("law-curve"), law);
      const at =
        law.at &&
        `at v0 = ${told(law.at.v0)}: μ_K = ${told(law.at.mu_k)}, slope μ′ = ` +
          told(law.at.mu_prime);
      element("law-told").textContent = at ?? "";
    } catch (error) {
      if (error.name !== "AbortError") element("law-told").textContent = error.message;
    }
  }
}
