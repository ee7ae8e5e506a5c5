// What can be set: as slipmap tells it, and what the page offers of it.

/** Controls, and their gains. */
export const GAINS = { velocity: ["alpha_v"], load: ["alpha_n"], mixed: ["alpha_v", "alpha_n"] };
/** Fields of which a chart is made while one looks on. */
export const SHOWN = ["n_unstable", "abscissa", "relaxation_time", "delay_margin", "frequency"];
/** Units of force, length and time; none are given for a dimensionless model. */
export const UNITS = {
  "": "none, dimensionless",
  "N,m,s": "N, m, s",
  "mN,mm,s": "mN, mm, s",
  "nN,nm,us": "nN, nm, µs",
};
/** The model that is a system from a text. */
export const FILE = "file";
/** The units of a view; a system has those of its text. */
export const unitsOf = ({ model, units }) => (model ? "" : units);
/** How many times farther than its slider an axis is moved. */
const FAR = 1000;
/** An axis is not narrower than this part of its values: its cells would be the same numbers. */
const NARROWEST = 1e-9;
/** Values of less than this do not make an axis that is narrower still. */
const SMALL = 1e-3;

/** Ends of a logarithmic axis that are as near to the given ones as can be. */
export function withoutZero([from, to]) {
  if (from * to > 0) return [from, to];
  const far = Math.max(Math.abs(from), Math.abs(to));
  return to > 0 ? [far / 1000, far] : [-far, -far / 1000];
}

export class Catalogue {
  /**
   * @param {{parameters: object[], laws: object[], fields: object[], flags: object[],
   *   systems: object[]}} told as slipmap answers
   */
  constructor({ parameters, laws, fields, flags, systems }) {
    Object.assign(this, { parameters, laws, fields, flags, systems });
    // Systems by their texts, as they are told.
    this.texts = new Map(systems.map((system) => [system.toml, system]));
    this.byName = new Map(parameters.map((parameter) => [parameter.name, parameter]));
    // The parameters of formulas, with those that only they have.
    this.formulas = new Map();
    const { formula, parameters: known } = this.law("formula");
    this.keep(formula, { known, own: [] });
    for (const system of systems) this.#name(system.name, system);
  }

  /** Lets the own parameters of a system be found. Other models may have such names, too. */
  #name(model, { own }) {
    for (const parameter of own) this.byName.set(`${model}-${parameter.name}`, parameter);
  }

  /** The system of a view; null of the block. While its text has a mistake, that of before. */
  system({ model, system, known }) {
    if (!model) return null;
    if (model !== FILE) return this.systems.find(({ name }) => name === model);
    const found = this.texts.get(system) ?? this.texts.get(known) ?? this.systems[0];
    if (this.named !== found) this.#name(FILE, found);
    this.named = found;
    return found;
  }

  /** The names by which the page knows the parameters of a view's system. */
  ofSystem(state) {
    const { own, others } = this.system(state);
    const named = own.filter(({ page }) => page).map(({ name }) => `${state.model}-${name}`);
    return [...named, ...others.filter((name) => this.about(name).page)];
  }

  /** The fields that can be shown of a view. */
  shown(state) {
    const system = this.system(state);
    return SHOWN.filter((name) => !system || system.fields.includes(name));
  }

  /** The parameters that axes begin with: gains and the delay; a gain has no smallest value. */
  #axesFirst(state, names) {
    if (!state.model) return [...GAINS[state.control], "tau", ...names];
    const own = names.filter((name) => this.about(name).group === "system");
    const gains = own.filter((name) => this.about(name).range[0] < 0);
    return [...(gains.length ? gains : own).slice(-1), "tau", ...names];
  }

  /** Whether a view is of a system, or of friction with a state: each cell of these takes longer. */
  isGeneral(state) {
    return state.model !== "" || (state.law !== "none" && !this.moves(state));
  }

  /** The limits of actuators that are on: they matter to motions alone. */
  limits(state) {
    const all = this.moves(state) ? this.folded("limits") : [];
    return all.filter((name) => name in state.values);
  }

  /** Whether motions are followed of the model of a view. */
  moves({ model, law }) {
    return !model && Boolean(this.law(law)?.motions);
  }

  /** Keeps the parameters of a formula: names of `known` ones, and what its `own` ones are. */
  keep(formula, { known, own }) {
    for (const parameter of own) this.byName.set(parameter.name, parameter);
    this.formulas.set(formula, { known, own: own.map(({ name }) => name) });
  }

  /** The parameters that only the formula of a view has; while it has a mistake, those before. */
  own(state) {
    return state.law === "formula" ? this.#formula(state).own : [];
  }

  #formula({ formula, understood }) {
    const none = { known: [], own: [] };
    return this.formulas.get(formula) ?? this.formulas.get(understood) ?? none;
  }

  /** The parameters by which the friction law of a view is described, besides μ_S. */
  described(state) {
    if (state.law === "formula") return [...this.#formula(state).known, ...this.own(state)];
    const { parameters = [], optional = [] } = this.law(state.law) ?? {};
    return [...parameters, ...optional];
  }

  /** What a parameter is. */
  about(name) {
    return this.byName.get(name);
  }

  /** The parameters of the block and its feedback that are folded away in a box of sliders. */
  folded(box) {
    const these = ({ group, page }) => group === "model" && page?.folded === box;
    return this.parameters.filter(these).map(({ name }) => name);
  }

  law(name) {
    return this.laws.find((law) => law.name === name);
  }

  /** The value of a parameter in a view. */
  value(state, name) {
    const { page, default: usual } = this.about(name);
    return state.values[name] ?? page.first ?? usual;
  }

  /** How far an axis is moved and zoomed: farther there is nothing to be found, and it takes long. */
  reach({ name, from, to }) {
    const {
      range: [low, high],
      page: { slider },
    } = this.about(name);
    const far = Math.max(...[...slider.map((end) => FAR * end), from, to].map(Math.abs));
    return [Math.max(low, -far), Math.min(high, far)];
  }

  /** Why an axis cannot be, in words; null where it can. */
  wrong({ name, from, to, log }) {
    const {
      range: [low, high],
      allowed,
    } = this.about(name);
    if (!(from < to)) return "from must be less than to";
    if (from < low || to > high) return `outside its range: ${allowed}`;
    const size = Math.max(Math.abs(from), Math.abs(to), SMALL);
    if (to - from < NARROWEST * size) return "too narrow";
    return log && !(from * to > 0) ? "a logarithmic axis does not reach 0" : null;
  }

  /**
   * An axis as it begins; of friction coefficients, where the static one is the largest.
   * @param {string} name
   * @param {object} state
   * @param {{name: string, from: number, to: number}} other the other axis
   * @param {number} highest the largest kinetic coefficient of a table
   */
  axis(name, state, other, highest = 0) {
    let [from, to] = this.about(name).page.axis;
    const ends = (of) => (other.name === of ? other : { from: this.value(state, of), to: NaN });
    if (name === "mu_s") {
      const { from: mu0, to: most } = ends("mu0");
      from = Math.max(from, state.law === "table" ? highest : most || mu0);
      to = Math.max(to, 2 * from);
    } else if (name === "mu0") {
      to = Math.min(to, ends("mu_s").from);
      from = Math.min(from, to / 10);
    }
    return { name, from, to, log: false };
  }

  /** Sets other parameters for axes that the control or the law leaves without; whether it did. */
  mendAxes(state, names, highest) {
    let mended = false;
    for (const [key, beside] of [
      ["x", "y"],
      ["y", "x"],
    ]) {
      const other = state[beside];
      if (names.includes(state[key].name) && state[key].name !== other.name) continue;
      const wanted = this.#axesFirst(state, names);
      const name = wanted.find((each) => each !== other.name);
      state[key] = this.axis(name, state, other, highest);
      mended = true;
    }
    return mended;
  }
}
