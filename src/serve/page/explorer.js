// The page: what is set on it becomes a chart, and a point of it an answer.

import { COLOURS, ChartView, NAMES } from "./chart.js";
import { Problem, askChart, askPoint } from "./request.js";

/** Parameters with sliders: name, text, and the range of the slider. */
const SLIDERS = [
  ["mu_prime", "μ′, slope of the friction law", -0.95, 0.5, -0.3],
  ["gain_from", "gain from", -4, 0, -1],
  ["gain_to", "gain to", 0, 4, 0.2],
  ["tau_to", "longest delay τ", 1, 40, 12],
];
/** Cells of a chart while something moves, and at rest. */
const [MOVING, RESTING] = [[300, 300], [800, 600]];
/** How long nothing moves before it rests, in milliseconds. */
const REST = 150;

const element = (id) => document.getElementById(id);
const view = new ChartView(element("chart"));
const state = { control: "alpha_v", point: null };
let [pending, resting, looking] = [null, null, null];

/** The sweep of the chart with so many cells. */
function sweep([columns, rows]) {
  const { control, mu_prime, gain_from, gain_to, tau_to } = state;
  return `boundaries = true
[axes]
${control} = { from = ${gain_from}, to = ${gain_to}, points = ${columns} }
tau = { from = 0.0, to = ${tau_to}, points = ${rows} }
[fixed]
mu_prime = ${mu_prime}
`;
}

function tell(error) {
  if (error.name === "AbortError") return;
  const help = error instanceof Problem && error.help ? ` (${error.help})` : "";
  const gone = error instanceof TypeError ? "The server does not answer; it may have ended." : null;
  element("problem").textContent = gone ?? error.message + help;
}

/** Asks for the chart, in place of one that was asked for before. */
async function ask(cells) {
  pending?.abort();
  pending = new AbortController();
  try {
    const chart = await askChart(sweep(cells), pending.signal);
    view.show(chart);
    element("problem").textContent = "";
    const count = (cells[0] * cells[1]).toLocaleString("en");
    element("speed").textContent = `${count} cells in ${chart.milliseconds.toFixed(1)} ms`;
    if (!state.point) moveTo(middle());
  } catch (error) {
    tell(error);
  }
}

function changed() {
  clearTimeout(resting);
  resting = setTimeout(() => ask(RESTING), REST);
  ask(MOVING);
}

const middle = () => [0, 1].map((axis) => view.ends(axis)).map(([from, to]) => (from + to) / 2);

const short = (x) => Number(x.toPrecision(7)).toString();

/** Moves the point, and says what the chart shows there. */
function moveTo(point) {
  state.point = view.point = point;
  view.draw();
  const [gain, tau] = point.map(short);
  const name = state.control === "alpha_v" ? "α_v" : "α_N";
  const count = view.countAt(point);
  const what = count === 0 ? "stable" : `${count} unstable roots`;
  element("readout").textContent = `${name} = ${gain}, τ = ${tau}: ${what}`;
}

/** Asks for everything at the point, by its exact values. */
async function look() {
  looking?.abort();
  looking = new AbortController();
  const [gain, tau] = state.point;
  const toml = `[fixed]\nmu_prime = ${state.mu_prime}\n${state.control} = ${gain}\ntau = ${tau}\n`;
  const flag = state.control.replace("_", "-");
  element("command").value =
    `slipmap point --mu-prime=${state.mu_prime} --${flag}=${gain} --tau ${tau}`;
  try {
    tellPoint(await askPoint(toml, looking.signal));
  } catch (error) {
    tell(error);
  }
}

function tellPoint(point) {
  const margin = point.delay_margin === null ? "infinite" : short(point.delay_margin);
  const intervals = point.stable_delays.slice(0, 8);
  const interval = ([from, to]) => `${short(from)} < τ < ${to === null ? "∞" : short(to)}`;
  const root = ([re, im]) => `${short(re)}${im === 0 ? "" : ` ± ${short(im)} i`}`;
  const verdict = point.marginal ? "marginal" : point.stable ? "stable" : "unstable";
  const rows = [
    ["sliding", `${verdict}, ${point.n_unstable} unstable roots`],
    ["delay margin", margin],
    ["abscissa", point.abscissa === null ? "unknown" : short(point.abscissa)],
    ["certified", point.certified ? "yes, by the argument principle" : "no"],
    ["stable delays", intervals.map(interval).join(", ") || "none"],
    ["roots", point.roots.slice(0, 6).map(root).join(", ")],
  ];
  const parts = rows.flatMap(([term, text]) => {
    const [dt, dd] = ["dt", "dd"].map((tag) => document.createElement(tag));
    [dt.textContent, dd.textContent] = [term, text];
    return [dt, dd];
  });
  element("point").replaceChildren(...parts);
}

function slider([name, text, from, to, at]) {
  state[name] = at;
  const part = document.createElement("div");
  part.className = "slider";
  const label = document.createElement("label");
  const [range, number] = ["range", "number"].map((type) => {
    const input = document.createElement("input");
    [input.type, input.step, input.value] = [type, "any", at];
    input.addEventListener("input", () => {
      const value = input.valueAsNumber;
      if (!Number.isFinite(value)) return;
      state[name] = value;
      for (const other of [range, number]) if (other !== input) other.value = value;
      changed();
    });
    return input;
  });
  [range.min, range.max, range.id, range.step] = [from, to, name, (to - from) / 1000];
  range.value = at;
  [label.htmlFor, label.textContent] = [name, text];
  number.setAttribute("aria-label", `${text}, as a number`);
  part.append(label, range, number);
  return part;
}

function begin() {
  element("sliders").append(...SLIDERS.map(slider));
  element("legend").append(...COLOURS.map((colour, i) => {
    const [item, box] = ["li", "i"].map((tag) => document.createElement(tag));
    box.style.background = colour;
    item.append(box, NAMES[i]);
    return item;
  }));
  element("controls").addEventListener("submit", (event) => event.preventDefault());
  for (const radio of document.querySelectorAll("input[name=control]")) {
    radio.addEventListener("change", () => {
      state.control = radio.value;
      state.point = view.point = null;
      changed();
    });
  }
  const canvas = element("chart");
  const at = (event) => {
    const box = canvas.getBoundingClientRect();
    return view.valueAt(event.clientX - box.left, event.clientY - box.top);
  };
  canvas.addEventListener("click", (event) => {
    moveTo(at(event));
    look();
  });
  canvas.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    if (event.key === "Enter") return look();
    if (!(event.key in step) || !state.point) return;
    event.preventDefault();
    const share = event.shiftKey ? 0.1 : 0.01;
    moveTo(state.point.map((value, axis) => {
      const [from, to] = view.ends(axis);
      const next = value + step[event.key][axis] * share * (to - from);
      return Math.min(to, Math.max(from, next));
    }));
  });
  new ResizeObserver(() => view.draw()).observe(canvas);
  changed();
}

begin();
