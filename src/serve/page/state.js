// The whole view as an address, short enough to be sent and readable: `#v=1&x=alpha_v,-1,0.2&…`.

/** What the page shows when the address says nothing: the letter's Fig. 2(a). */
export const START = {
  control: "velocity",
  x: { name: "alpha_v", from: -1.6, to: 0.4, log: false },
  y: { name: "tau", from: 0, to: 12, log: false },
  values: { mu_prime: -0.3 },
  law: "none",
  table: "",
  units: "",
  show: "n_unstable",
  point: null,
  start: null,
  map: null,
};

/** The first word of every address that this page understands. */
const VERSION = "1";
/** A table of friction that is longer has no place in an address. */
const LONGEST_TABLE = 1500;

const number = (text) => (text.trim() === "" ? NaN : Number(text));
const numbers = (text) => text.split(",").map(number);

/**
 * The fragment of the address of a view.
 * @param {object} state
 * @param {string[]} parameters those on which the chart depends
 * @returns {string} beginning with #
 */
export function addressOf(state, parameters) {
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
    put("control", state.control);
    put("x", axis(state.x));
    put("y", axis(state.y));
    for (const name of parameters) if (name in state.values) put(name, state.values[name]);
    if (state.law !== "none") put("law", state.law);
    if (state.law === "table" && state.table.length <= LONGEST_TABLE) {
      put(
        "table",
        state.table
          .trim()
          .replace(/[ \t]*\n[ \t]*/g, ";")
          .replace(/[ \t]+/g, ""),
      );
    }
    if (state.units) put("units", state.units);
    if (state.show !== START.show) put("show", state.show);
    if (state.point) put("at", state.point.join(","));
  }
  if (state.start) put("start", state.start.join(","));
  const plain = (text) => encodeURIComponent(text).replace(/%2C/g, ",").replace(/%3B/g, ";");
  return `#${parts.map(([key, value]) => `${key}=${plain(value)}`).join("&")}`;
}

/** Keys of an address that are no parameters. */
const WORDS = new Set([
  "v",
  "control",
  "x",
  "y",
  "law",
  "table",
  "units",
  "show",
  "at",
  "start",
  "map",
  "field",
  "xr",
  "yr",
  "xlog",
  "ylog",
  "slice",
]);

function axisOf(text, otherwise) {
  const [name, from, to, log] = (text ?? "").split(",");
  const ends = [number(from ?? ""), number(to ?? "")];
  if (!/^[a-z_0-9]+$/.test(name) || !(ends[0] < ends[1])) return otherwise;
  return { name, from: ends[0], to: ends[1], log: log === "log" };
}

const pairOf = (text) => {
  const pair = text ? numbers(text) : [];
  return pair.length === 2 && pair.every(Number.isFinite) ? pair : null;
};

/**
 * The view of an address; what it does not say, or not in an understandable way, is as at the start.
 * @param {string} fragment
 */
export function stateOf(fragment) {
  const said = new URLSearchParams(fragment.replace(/^#/, ""));
  const get = (key) => said.get(key);
  const state = { ...START, x: { ...START.x }, y: { ...START.y }, values: { ...START.values } };
  if (get("v") !== VERSION) return state;
  state.start = pairOf(get("start"));
  if (/^[0-9a-f]{16}$/.test(get("map") ?? "")) {
    const at = [...said].filter(([key]) => key.startsWith("at."));
    const named = (key) => (/^[a-z_0-9]+$/.test(get(key) ?? "") ? get(key) : null);
    state.map = {
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
    return state;
  }
  if (["velocity", "load", "mixed"].includes(get("control"))) state.control = get("control");
  state.x = axisOf(get("x"), state.x);
  state.y = axisOf(get("y"), state.y);
  if (get("law")) state.law = get("law");
  if (get("table")) state.table = get("table").replace(/;/g, "\n");
  if (get("units")) state.units = get("units");
  if (get("show")) state.show = get("show");
  state.point = pairOf(get("at"));
  for (const [key, text] of said) {
    const value = number(text);
    if (!WORDS.has(key) && /^[a-z_0-9]+$/.test(key) && Number.isFinite(value))
      state.values[key] = value;
  }
  return state;
}
