// Texts in TOML for what is set on the page: the same words as in sweep and case files.

import { GAINS } from "./catalogue.js";
import { unitOf } from "./scale.js";

/** The parameters on which what is shown depends, in the order in which they are set. */
export function parametersOf(state, catalogue) {
  // Of parameters that say the same, the page offers as many as a law needs.
  const described = catalogue.described(state).filter((name) => catalogue.about(name).page);
  const sliding = state.law === "none" ? ["mu_prime", "mu_k"] : ["v0", ...described, "mu_s"];
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

/** The tables [friction] and [units]. */
function tablesOf(state, catalogue, names) {
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
  return lines.map((name) => line(name, catalogue.value(state, name))).join("");
}

/** The parameters of a chart that are no axes of it, with their values. */
export function besides(state, catalogue) {
  const axes = [state.x.name, state.y.name];
  const names = parametersOf(state, catalogue).filter((name) => !axes.includes(name));
  return given(state, catalogue, names).map((name) => {
    const { symbol, dimension } = catalogue.about(name);
    const unit = unitOf(dimension, state.units);
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
 */
export function sweepOf(state, catalogue, points, fields) {
  const axes = [state.x, state.y];
  const names = parametersOf(state, catalogue).filter((name) =>
    axes.every((axis) => axis.name !== name),
  );
  const described = axes.map(({ name, from, to, log }, i) => {
    const spacing = log ? ', spacing = "log"' : "";
    return `${name} = { from = ${from}, to = ${to}, points = ${points[i]}${spacing} }\n`;
  });
  const curves = axes.some(({ name }) => name === "tau") ? "boundaries = true\n" : "";
  const list = fields.map((field) => `"${field}"`).join(", ");
  return (
    `fields = [${list}]\n${curves}\n[axes]\n${described.join("")}\n` +
    withFixed(fixedOf(state, catalogue, names)) +
    tablesOf(state, catalogue, names)
  );
}

/** What is asked at a point of the chart: `point`, `vc` or, with a start, `motion`. */
export function pointTexts(state, catalogue, point) {
  const given = { [state.x.name]: point[0], [state.y.name]: point[1] };
  const at = { ...state, values: { ...state.values, ...given } };
  const names = parametersOf(state, catalogue);
  const tables = tablesOf(at, catalogue, names);
  const text = withFixed(fixedOf(at, catalogue, names)) + tables;
  if (state.law === "none") return { point: text, vc: null, motion: null };
  const without = names.filter((name) => name !== "v0");
  return {
    point: text,
    vc: withFixed(fixedOf(at, catalogue, without)) + tables,
    motion: text,
    v0: catalogue.value(at, "v0"),
  };
}
