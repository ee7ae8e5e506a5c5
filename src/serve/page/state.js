// The whole view as an address, short enough to be sent and readable: `#v=1&x=alpha_v,-1,0.2&…`.

import { FILE, GAINS, UNITS } from "./catalogue.js";
import { parametersOf } from "./sweep.js";

/** What the page shows when the address says nothing: the letter's Fig. 2(a). */
const START = {
  // The block on its spring; else the name of a system, or that of one from a text.
  model: "",
  // The text of such a system, and the last one that was understood.
  system: "",
  known: "",
  control: "velocity",
  x: { name: "alpha_v", from: -1.6, to: 0.4, log: false },
  y: { name: "tau", from: 0, to: 12, log: false },
  values: { mu_prime: -0.3 },
  law: "none",
  // The expression of a formula, and the last one that was understood.
  formula: "",
  understood: "",
  table: "",
  columns: "",
  speedUnit: "",
  // The largest kinetic coefficient of the table, once it is read.
  highest: 0,
  units: "",
  show: "n_unstable",
  point: null,
  start: null,
  // The address of the setting that is compared.
  compared: null,
  map: null,
};

/** The first word of every address that this page understands. */
const VERSION = "1";
/** A table of friction or a system that takes more characters has no place in an address. */
const LONGEST_TEXT = 1500;

const number = (text) => (text.trim() === "" ? NaN : Number(text));
const numbers = (text) => text.split(",").map(number);

const tableText = ({ model, law, table }) => (!model && law === "table" ? table.trim() : "");
const systemText = ({ model, system }) => (model === FILE ? system.trim() : "");

/** What of a view is too long for its address, in a word; null where nothing is. */
export function leftOut(state) {
  if (state.map) return null;
  if (systemText(state).length > LONGEST_TEXT) return "system";
  return tableText(state).length > LONGEST_TEXT ? "table" : null;
}

const saidBy = (fragment) => new URLSearchParams(fragment.replace(/^#/, ""));

/** The formula and the system of an address; null where it says none. */
export function textsOf(fragment) {
  const said = saidBy(fragment);
  return { formula: said.get("formula"), system: said.get("system") };
}

/** The address, of the live chart, of what is compared with an address; null where nothing is. */
export function comparedOf(fragment) {
  const compared = saidBy(fragment).get("compare");
  const said = saidBy(compared ?? "");
  return said.get("v") === VERSION && !said.has("map") ? compared : null;
}

/** The word for a parameter in an address: names that only a formula has could be other words. */
const wordOf = (name, own) => (own.includes(name) ? `own.${name}` : name);

/**
 * The fragment of the address of a view.
 * @param {object} state
 * @param {import("./catalogue.js").Catalogue} catalogue
 * @returns {string} beginning with #
 */
export function addressOf(state, catalogue) {
  const parts = [["v", VERSION]];
  const put = (key, value) => parts.push([key, String(value)]);
  const axis = ({ name, from, to, log }) => `${name},${from},${to}${log ? ",log" : ""}`;
  const { map } = state;
  if (map) {
    put("map", map.id);
    for (const key of ["field", "x", "y", "slice"]) if (map[key]) put(key, map[key]);
    for (const [key, range] of [
      ["xr", map.xr],
      ["yr", map.yr],
    ])
      if (range) put(key, range.join(","));
    for (const key of ["xlog", "ylog"]) if (map[key]) put(key, 1);
    for (const [name, index] of Object.entries(map.at ?? {})) put(`at.${name}`, index);
  } else {
    const { model } = state;
    const law = model ? "none" : state.law;
    if (model) put("model", model);
    else put("control", state.control);
    put("x", axis(state.x));
    put("y", axis(state.y));
    const own = catalogue.own(state);
    for (const name of [...parametersOf(state, catalogue), ...catalogue.limits(state)])
      if (name in state.values) put(wordOf(name, own), state.values[name]);
    const system = systemText(state);
    if (system && system.length <= LONGEST_TEXT) put("system", state.system);
    if (law !== "none") put("law", law);
    if (law === "formula") put("formula", state.formula);
    const table = tableText(state);
    if (table.length <= LONGEST_TEXT && table) put("table", table);
    if (table && state.columns) put("columns", state.columns);
    if (table && state.speedUnit) put("speed_unit", state.speedUnit);
    if (!model && state.units) put("units", state.units);
    if (state.show !== START.show) put("show", state.show);
    if (state.point) put("at", state.point.join(","));
  }
  if (state.start) put("start", state.start.join(","));
  if (state.compared) put("compare", state.compared);
  const plain = (text) => encodeURIComponent(text).replace(/%2C/g, ",").replace(/%3A/g, ":");
  return `#${parts.map(([key, value]) => `${key}=${plain(value)}`).join("&")}`;
}

/** An axis as an address says it; null if it says none. */
function axisOf(text) {
  if (text === null) return null;
  const [name, from, to, scale] = text.split(",");
  return { name, from: number(from ?? ""), to: number(to ?? ""), log: scale === "log" };
}

/** Sets the axes of a view where there can be such ones. */
function readAxes(state, said, catalogue, notes) {
  const known = parametersOf(state, catalogue);
  const { highest } = state;
  for (const [key, beside, title] of [
    ["x", "y", "across"],
    ["y", "x", "upwards"],
  ]) {
    const axis = axisOf(said.get(key));
    if (!axis) continue;
    if (!known.includes(axis.name)) {
      notes.push(`the axis ${title}, "${axis.name}", is no parameter of this model`);
      continue;
    }
    const wrong = catalogue.wrong(axis);
    if (wrong) {
      notes.push(`the axis ${title}, ${axis.name} from ${axis.from} to ${axis.to}: ${wrong}`);
      state[key] = catalogue.axis(axis.name, state, state[beside], highest);
    } else {
      state[key] = axis;
    }
  }
  if (state.x.name === state.y.name) notes.push("both axes are the same");
  catalogue.mendAxes(state, known, highest);
}

const pairOf = (text) => {
  const pair = text ? numbers(text) : [];
  return pair.length === 2 && pair.every(Number.isFinite) ? pair : null;
};

/** What is shown of a map, as an address says it. */
function mapOf(said) {
  const get = (key) => said.get(key);
  const at = [...said].filter(([key]) => key.startsWith("at."));
  const named = (key) => (/^[a-z_0-9]+$/.test(get(key) ?? "") ? get(key) : null);
  return {
    id: get("map"),
    field: named("field"),
    x: named("x"),
    y: named("y"),
    slice: named("slice"),
    xr: pairOf(get("xr")),
    yr: pairOf(get("yr")),
    xlog: get("xlog") === "1",
    ylog: get("ylog") === "1",
    at: Object.fromEntries(
      at.map(([key, index]) => [key.slice(3), Math.max(0, number(index) || 0)]),
    ),
  };
}

/** Sets the model of a view; a system whose text is understood. */
function readModel(state, get, catalogue) {
  const [model, text] = [get("model"), get("system")];
  if (!model) return;
  if (model === FILE && text === null) {
    state.notes.push("its system was too long: paste it again");
  } else if (model === FILE || catalogue.systems.some(({ name }) => name === model)) {
    [state.model, state.system] = [model, text ?? ""];
  } else {
    state.notes.push(`"${model}" is no model of the live chart`);
  }
}

/**
 * The view of an address, whose formula and system are known already. What it does not say, or not
 * in an understandable way, is as at the start, and `notes` tell of it.
 * @param {string} fragment
 * @param {import("./catalogue.js").Catalogue} catalogue
 */
export function stateOf(fragment, catalogue) {
  const said = saidBy(fragment);
  const get = (key) => said.get(key);
  const notes = [];
  const state = { ...START, x: { ...START.x }, y: { ...START.y }, values: { ...START.values } };
  state.notes = notes;
  state.formula = catalogue.law("formula").formula;
  if (get("v") !== VERSION) {
    if ([...said].length > 0) notes.push("it is none of this version of the page");
    return state;
  }
  [state.start, state.compared] = [pairOf(get("start")), comparedOf(fragment)];
  if (get("compare") !== null && state.compared === null)
    notes.push("what it compares with is no setting of the live chart");
  if (/^[0-9a-f]{16}$/.test(get("map") ?? "")) {
    state.map = mapOf(said);
    return state;
  }
  readModel(state, get, catalogue);
  for (const [key, what, offered] of [
    ["control", "control", Object.keys(GAINS)],
    ["law", "friction law", ["none", ...catalogue.laws.map(({ name }) => name)]],
    ["units", "units", Object.keys(UNITS)],
    ["show", "field", catalogue.shown(state)],
  ]) {
    const value = get(key);
    if (value === null) continue;
    if (offered.includes(value)) state[key] = value;
    else notes.push(`"${value}" is no ${what} of the live chart`);
  }
  [state.columns, state.speedUnit] = [get("columns") ?? "", get("speed_unit") ?? ""];
  if (get("formula") !== null) state.formula = get("formula");
  if (get("table")) state.table = get("table");
  else if (state.law === "table") notes.push("its table was too long: paste it again");
  const own = catalogue.own(state);
  const limits = catalogue.moves(state) ? catalogue.folded("limits") : [];
  for (const name of [...parametersOf(state, catalogue), ...limits]) {
    const text = get(wordOf(name, own));
    if (text === null) continue;
    const [value, about] = [number(text), catalogue.about(name)];
    if (value >= about.range[0] && value <= about.range[1]) state.values[name] = value;
    else notes.push(`${name} = ${text} is outside its range: ${about.allowed}`);
  }
  readAxes(state, said, catalogue, notes);
  state.point = pairOf(get("at"));
  return state;
}
