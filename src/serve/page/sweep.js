// Texts in TOML for what is set on the page: the same words as in sweep and case files.

/** Parameters of the block, its spring and its load. */
export const MODEL = ["mass", "stiffness", "normal_load"];
const GAINS = { velocity: ["alpha_v"], load: ["alpha_n"], mixed: ["alpha_v", "alpha_n"] };

/** Where nothing else is said. */
export const VALUES = {
  mu_prime: -0.3,
  mu_k: 1,
  v0: 0.35,
  mu0: 0.5,
  v_s: 0.5,
  mu_s: 1,
  alpha_v: -0.33,
  alpha_n: -2,
  tau: 4.15,
  mass: 1,
  stiffness: 1,
  normal_load: 1,
};

/** The parameters on which what is shown depends, in the order in which they are set. */
export function parametersOf(state, laws) {
  const law = laws.find(({ name }) => name === state.law);
  // Of three that say the same, the page sets two.
  const described = (law?.parameters ?? []).filter((name) => name !== "mu_prime_rest");
  const sliding = state.law === "none" ? ["mu_prime", "mu_k"] : ["v0", ...described, "mu_s"];
  return [...sliding, ...GAINS[state.control], "tau", ...MODEL];
}

const ofLaw = (name) => ["mu0", "v_s", "mu_s"].includes(name);
const line = (name, value) => `${name} = ${value}\n`;

/** The points of a friction law from two columns: v and μ_K. */
export function tableOf(text) {
  const rows = text
    .trim()
    .split(/\r?\n/)
    .filter((row) => row.trim() && !/^\s*[#%a-z]/i.test(row));
  const pairs = rows.map((row) =>
    row
      .trim()
      .split(/[\s,;]+/)
      .map(Number),
  );
  const wrong = pairs.findIndex(
    (pair) => pair.length < 2 || !pair.slice(0, 2).every(Number.isFinite),
  );
  if (wrong >= 0) throw new RangeError(`line ${wrong + 1} of the table is no pair of numbers`);
  if (pairs.length < 2) throw new RangeError("the table needs two points or more: v, μ_K");
  return { speeds: pairs.map(([v]) => v), mu_k: pairs.map(([, mu]) => mu) };
}

/** The tables [friction] and [units]. */
function tablesOf(state, names) {
  const value = (name) => state.values[name] ?? VALUES[name];
  let text = "";
  if (state.law !== "none") {
    text += `\n[friction]\nlaw = "${state.law}"\n`;
    if (state.law === "table") {
      const { speeds, mu_k } = tableOf(state.table);
      text += `speeds = [${speeds.join(", ")}]\nmu_k = [${mu_k.join(", ")}]\n`;
    }
    text += names
      .filter(ofLaw)
      .map((name) => line(name, value(name)))
      .join("");
  }
  if (state.units) {
    const [force, length, time] = state.units.split(",");
    text += `\n[units]\nforce = "${force}"\nlength = "${length}"\ntime = "${time}"\n`;
  }
  return text;
}

/** The table [fixed] of parameters, without those that are as if not given. */
function fixedOf(state, names, given = {}) {
  const ones = [...MODEL, "mu_k"];
  const value = (name) => given[name] ?? state.values[name] ?? VALUES[name];
  const kept = names.filter((name) => !ofLaw(name) && !(ones.includes(name) && value(name) === 1));
  return kept.map((name) => line(name, value(name))).join("");
}

const withFixed = (text) => (text ? `[fixed]\n${text}` : "");

/**
 * The sweep file of the chart.
 * @param {object} state see state.js
 * @param {object[]} laws
 * @param {[number, number]} points along x and y
 * @param {string[]} fields
 */
export function sweepOf(state, laws, points, fields) {
  const axes = [state.x, state.y];
  const names = parametersOf(state, laws).filter((name) =>
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
    withFixed(fixedOf(state, names)) +
    tablesOf(state, names)
  );
}

/** What is asked at a point of the chart: `point`, `vc` or, with a start, `motion`. */
export function pointTexts(state, laws, point) {
  const given = { [state.x.name]: point[0], [state.y.name]: point[1] };
  const at = { ...state, values: { ...state.values, ...given } };
  const names = parametersOf(state, laws);
  const others = [state.x.name, state.y.name].filter((name) => !names.includes(name));
  const all = [...names, ...others];
  const text = withFixed(fixedOf(at, all)) + tablesOf(at, all);
  if (state.law === "none") return { point: text, vc: null, motion: null };
  const without = all.filter((name) => name !== "v0");
  return {
    point: text,
    vc: withFixed(fixedOf(at, without)) + tablesOf(at, all),
    motion: text,
    v0: at.values.v0 ?? VALUES.v0,
  };
}
