// Where the stable region lies, and the best setting in it.

import { GAINS } from "./catalogue.js";
import { sweepOf } from "./sweep.js";

/** Cells of the charts in which a region is looked for, along x and y. */
const CELLS = [300, 240];
/** What is searched of an axis where only what is usual is asked for, as a part of it. */
const CORNER = 1e-3;
/** What is shown around a region, as a part of it. */
const ROOM = 0.12;

/** The plane of gain and delay in which the best setting is searched for. */
const searched = (state) => {
  // Of a system any parameter is searched.
  if (state.model) return [[state.x, state.y].find(({ name }) => name !== "tau").name, "tau"];
  const gains = GAINS[state.control];
  const gain = [state.x, state.y].find(({ name }) => gains.includes(name))?.name ?? gains[0];
  return [gain, "tau"];
};

/** Whether both axes are those of a search. */
export const isSearched = (state) =>
  searched(state).every((name) => [state.x, state.y].some((axis) => axis.name === name));

/** The text of a search in a plane with these ends, by name. */
function searchText(state, catalogue, ends) {
  const [gain, tau] = searched(state);
  const axis = (name) => ({ name, from: ends[name][0], to: ends[name][1], log: false });
  const plane = { ...state, x: axis(gain), y: axis(tau) };
  return sweepOf(plane, catalogue, [2, 2], ["n_unstable"]);
}

/** The best setting within the axes of a view. */
export function bestIn(state, catalogue, source, signal) {
  const ends = Object.fromEntries(
    [state.x, state.y].map(({ name, from, to }) => [name, [from, to]]),
  );
  return source.best(searchText(state, catalogue, ends), signal);
}

/** The ends of both axes within which everything is looked for: those of a search, or of a slider. */
async function widest(state, catalogue, source, signal) {
  const names = searched(state);
  // What is usual does not depend on where is searched, and a corner is searched soon.
  const corner = ([from, to]) => [from, from + CORNER * (to - from)];
  const first = Object.fromEntries(
    names.map((name) => [name, corner(catalogue.about(name).page.axis)]),
  );
  // Where nothing is searched, the ends of the sliders do.
  const none = (error) => {
    if (signal.aborted || !error.status) throw error;
    return {};
  };
  const asked = source.best(searchText(state, catalogue, first), signal);
  const { usual } = await asked.catch(none);
  const ends = usual ? { [names[0]]: usual.gain, tau: usual.tau } : {};
  return [state.x, state.y].map(({ name, log }) => {
    const [from, to] = ends[name] ?? catalogue.about(name).page.slider;
    return { name, from, to, log: log && from * to > 0 };
  });
}

/** The stable cells of a chart that belong to the cell of `point`; else those of the largest region. */
function regionOf({ nx, ny, counts }, near) {
  const seen = new Uint8Array(nx * ny);
  let best = null;
  for (let start = 0; start < nx * ny; start++) {
    if (seen[start] || counts[start] !== 0) continue;
    const cells = [start];
    seen[start] = 1;
    for (let k = 0; k < cells.length; k++) {
      const [i, j] = [Math.floor(cells[k] / ny), cells[k] % ny];
      for (const [p, q] of [
        [i - 1, j],
        [i + 1, j],
        [i, j - 1],
        [i, j + 1],
      ]) {
        const n = p * ny + q;
        if (p < 0 || q < 0 || p >= nx || q >= ny || seen[n] || counts[n] !== 0) continue;
        seen[n] = 1;
        cells.push(n);
      }
    }
    if (near !== null && cells.includes(near)) return cells;
    if (!best || cells.length > best.length) best = cells;
  }
  return best;
}

/** The cell of a chart that is nearest to a point; null outside. */
function cellAt({ axes, ny }, point) {
  if (!point) return null;
  const index = axes.map(({ values }, axis) => {
    const [low, high] = [values[0], values[values.length - 1]];
    if (point[axis] < low || point[axis] > high) return -1;
    let near = 0;
    values.forEach((value, i) => {
      if (Math.abs(value - point[axis]) < Math.abs(values[near] - point[axis])) near = i;
    });
    return near;
  });
  return index.includes(-1) ? null : index[0] * ny + index[1];
}

/** The counts of a chart; NaN where a cell shows none, such as a marginal one. */
export function countsOf(chart) {
  const { values, gaps } = chart.fields.find(({ name }) => name === "n_unstable");
  return Array.from(values, (count, n) => (gaps?.[n] ? NaN : count));
}

/** A chart of counts over two axes. */
async function countsOver(state, catalogue, source, [x, y], signal) {
  const text = sweepOf({ ...state, x, y }, catalogue, CELLS, ["n_unstable"], false);
  const chart = await source.chart(text, signal);
  const [nx, ny] = chart.axes.map(({ values }) => values.length);
  return { axes: chart.axes, nx, ny, counts: countsOf(chart) };
}

/** The ends of cells along both axes, with some room, and their middle cell. */
function boxOf({ axes, ny }, cells, room) {
  const parts = cells.map((n) => [Math.floor(n / ny), n % ny]);
  const middle = [0, 1].map((axis) => parts.reduce((sum, p) => sum + p[axis], 0) / parts.length);
  const distance = (p) => Math.hypot(p[0] - middle[0], p[1] - middle[1]);
  const centre = parts.reduce((near, p) => (distance(p) < distance(near) ? p : near));
  const ends = axes.map(({ values }, axis) => {
    const all = parts.map((p) => p[axis]);
    const [low, high] = all.reduce(([a, b], i) => [Math.min(a, i), Math.max(b, i)], [
      Infinity,
      -Infinity,
    ]);
    const [from, to] = [values[low], values[high]];
    const step = Math.abs(values[Math.min(1, values.length - 1)] - values[0]);
    const more = Math.max(room * (to - from), step);
    return [from - more, to + more];
  });
  return { ends, centre: axes.map(({ values }, axis) => values[centre[axis]]) };
}

/**
 * The ends of both axes that show the stable region of a view, and a point in it: the region of the
 * marked point, `near`, or else the largest one. None where nothing is stable.
 * @returns {Promise<{ends: [number, number][], centre: number[]} | null>}
 */
export async function stableRegion(state, catalogue, source, near, signal) {
  let axes = await widest(state, catalogue, source, signal);
  let found = null;
  // The second time its ends are seen more exactly.
  for (const room of [1, ROOM]) {
    const chart = await countsOver(state, catalogue, source, axes, signal);
    const cells = regionOf(chart, cellAt(chart, found?.centre ?? near));
    if (!cells) return found;
    found = boxOf(chart, cells, room);
    axes = axes.map((axis, i) => {
      const { range } = catalogue.about(axis.name);
      const [from, to] = found.ends[i].map((x) => Math.min(range[1], Math.max(range[0], x)));
      return { ...axis, from, to, log: axis.log && from * to > 0 };
    });
    found.ends = axes.map(({ from, to }) => [from, to]);
  }
  return found;
}
