// Texts in TOML for what is set on the page: the same words as in sweep and case files.

import { FILE, GAINS, unitsOf } from "./catalogue.js";
import { unitOf } from "./scale.js";

/** The parameters on which the chart depends, in the order in which they are set. */
export function parametersOf(state, catalogue) {
  if (state.model) return catalogue.ofSystem(state);
  // Of parameters that say the same, the page offers as many as a law needs.
  const described = catalogue.described(state).filter((name) => catalogue.about(name).page);
  const resting = catalogue.law(state.law)?.motions ? ["mu_s"] : [];
  const sliding = state.law === "none" ? ["mu_prime", "mu_k"] : ["v0", ...described, ...resting];
  const folded = ["feedback", "model"].flatMap((box) => catalogue.folded(box));
  return [...sliding, ...GAINS[state.control], "tau", ...folded];
}

const line = (name, value) => `${name} = ${value}\n`;

/** A text as TOML writes it. */
export const quoted = (text) => JSON.stringify(text).replace(/\x7f/g, "\\u007f");

/** The text of a measured friction law, and what is said of its columns. */
function tableOf({ table, columns, speedUnit }) {
  const said = [
    ["text", table],
    ["columns", columns],
    ["speed_unit", speedUnit],
  ];
  const keys = said.filter(([key, value]) => key === "text" || value);
  return `table = { ${keys.map(([key, value]) => `${key} = ${quoted(value)}`).join(", ")} }\n`;
}

/** The line that names the system of a view; none of the block. */
function systemOf(state, catalogue) {
  if (!state.model) return "";
  if (state.model === FILE && !catalogue.texts.has(state.system))
    throw new RangeError("The system is not understood: its mistake is told below its text.");
  return line("system", catalogue.system(state).value);
}

/** The tables [friction] and [units]. */
function tablesOf(state, catalogue, names) {
  if (state.model) return "";
  const value = (name) => catalogue.value(state, name);
  let text = "";
  if (state.law !== "none") {
    text += `\n[friction]\nlaw = "${state.law}"\n`;
    if (state.law === "table") text += tableOf(state);
    if (state.law === "formula") text += line("mu_k", quoted(state.formula));
    text += names
      .filter((name) => catalogue.about(name).group === "law")
      .map((name) => line(name, value(name)))
      .join("");
  }
  if (state.units) {
    const [force, length, time] = state.units.split(",");
    text += `\n[units]\nforce = "${force}"\nlength = "${length}"\ntime = "${time}"\n`;
  }
  return text;
}

/** Those of the parameters that are not as if not given. */
function given(state, catalogue, names) {
  const usual = (name) => {
    const { page, default: usually } = catalogue.about(name);
    return page.folded && catalogue.value(state, name) === usually;
  };
  return names.filter((name) => !usual(name));
}

/** The table [fixed] of parameters, without those that are as if not given. */
function fixedOf(state, catalogue, names) {
  const kept = names.filter((name) => catalogue.about(name).group !== "law");
  const lines = given(state, catalogue, kept);
  const word = (name) => catalogue.about(name).name;
  return lines.map((name) => line(word(name), catalogue.value(state, name))).join("");
}

/** The parameters of a chart that are no axes of it, with their values. */
export function besides(state, catalogue) {
  const axes = [state.x.name, state.y.name];
  const names = parametersOf(state, catalogue).filter((name) => !axes.includes(name));
  return given(state, catalogue, names).map((name) => {
    const { symbol, dimension, unit: own } = catalogue.about(name);
    const unit = own === "1" ? unitOf(dimension, unitsOf(state)) : own;
    return { name, symbol, unit, value: catalogue.value(state, name) };
  });
}

const withFixed = (text) => (text ? `[fixed]\n${text}` : "");

/**
 * The sweep file of the chart.
 * @param {object} state see state.js
 * @param {import("./catalogue.js").Catalogue} catalogue
 * @param {[number, number]} points along x and y
 * @param {string[]} fields
 * @param {boolean} [curved] whether curves are wanted where there can be such
 */
export function sweepOf(state, catalogue, points, fields, curved = true) {
  const axes = [state.x, state.y];
  const names = parametersOf(state, catalogue).filter((name) =>
    axes.every((axis) => axis.name !== name),
  );
  const described = axes.map(({ name, from, to, log }, i) => {
    const spacing = log ? ', spacing = "log"' : "";
    const word = catalogue.about(name).name;
    return `${word} = { from = ${from}, to = ${to}, points = ${points[i]}${spacing} }\n`;
  });
  const delay = axes.some(({ name }) => name === "tau");
  // Without a key, planes that can have curves are walked for them.
  const curves = delay || !curved ? `boundaries = ${curved}\n` : "";
  const list = fields.map((field) => `"${field}"`).join(", ");
  return (
    `${systemOf(state, catalogue)}fields = [${list}]\n${curves}\n[axes]\n${described.join("")}\n` +
    withFixed(fixedOf(state, catalogue, names)) +
    tablesOf(state, catalogue, names)
  );
}

/** What is asked at a point of the chart: `point`, `vc` or, with a start, `motion`. */
export function pointTexts(state, catalogue, point) {
  const given = { [state.x.name]: point[0], [state.y.name]: point[1] };
  const at = { ...state, values: { ...state.values, ...given } };
  const names = [...parametersOf(state, catalogue), ...catalogue.limits(state)];
  const tables = tablesOf(at, catalogue, names);
  const text = systemOf(state, catalogue) + withFixed(fixedOf(at, catalogue, names)) + tables;
  if (!catalogue.moves(state)) return { point: text, vc: null, motion: null };
  const without = names.filter((name) => name !== "v0");
  return {
    point: text,
    vc: withFixed(fixedOf(at, catalogue, without)) + tables,
    motion: text,
    v0: catalogue.value(at, "v0"),
  };
}
