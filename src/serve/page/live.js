// The chart that is computed now: from what is set to a plane with its curves.

import { flagsOf } from "./cells.js";
import { coloursOf } from "./colours.js";
import { element } from "./dom.js";
import { Newest } from "./newest.js";
import { countsOf } from "./region.js";
import { Scale } from "./scale.js";
import { besides, sweepOf } from "./sweep.js";
import { Waiting } from "./waiting.js";

/** Cells of a chart along x and y. */
const CELLS = [800, 600];
/** The same while something moves: as many as a picture of each frame has time for. */
export const FEWER_CELLS = [400, 300];
/** How long nothing moves before it rests, in milliseconds. */
const REST = 150;
/** After this a chart is given up for a newer one, in milliseconds. */
const PATIENCE = 500;
/** Fields whose cells cost no more than counts. */
const QUICK = ["n_unstable", "delay_margin"];
/** The scale of an axis from the edge of its first cell to that of its last one. */
function edges({ values }, log) {
  const scale = new Scale(values[0], values[values.length - 1], log);
  const half = values.length > 1 ? 0.5 / (values.length - 1) : 0;
  return scale.between(-half, 1 + half);
}

/** Curves with x first, whatever stands first in a vertex. */
function curvesOf(chart) {
  const turned = chart.axes[0].name === "tau";
  if (!turned) return chart.curves;
  return chart.curves.map((curve) => {
    const values = new Float64Array(curve.values.length);
    for (let k = 0; k + 1 < values.length; k += 2) {
      [values[k], values[k + 1]] = [curve.values[k + 1], curve.values[k]];
    }
    return { ...curve, values };
  });
}

export class Live {
  /**
   * @param {object} source see source.js
   * @param {import("./stale.js").Stale} stale
   * @param {{shown: Function, failed: Function}} told
   */
  constructor(source, catalogue, stale, told) {
    this.stale = stale;
    this.catalogue = catalogue;
    this.fields = Object.fromEntries(catalogue.fields.map((field) => [field.name, field]));
    this.told = told;
    const ask = async (question, signal) => {
      try {
        return await source.chart(question.text, signal);
      } catch (error) {
        if (error.name !== "AbortError") this.refused = question.number;
        throw error;
      }
    };
    // A chart of before does not stand for what is refused.
    const show = (chart, question) => question.number > this.refused && this.#show(chart, question);
    [this.number, this.refused] = [0, 0];
    const failed = (error) => this.#failed(error);
    this.requests = new Newest(ask, show, failed, { most: 2, patience: PATIENCE });
    this.waiting = new Waiting(element("chart-waiting"), "The chart", {
      stop: () => {
        clearTimeout(this.resting);
        this.requests.stop();
        this.stale.fail();
      },
      again: () => this.changed(this.state),
    });
  }

  /** The sweep file of what is set. */
  text(state, cells = CELLS, fields = [...new Set(["n_unstable", state.show])], curved = true) {
    return sweepOf(state, this.catalogue, cells, fields, curved);
  }

  /** What is set has changed, and may change again soon. */
  changed(state) {
    clearTimeout(this.resting);
    this.state = state;
    this.set = this.stale.ask();
    const quick = QUICK.includes(state.show) ? state.show : "n_unstable";
    this.#want(state, [...new Set(["n_unstable", quick])], quick);
    // What takes longer is looked for where it is shown.
    const besides = this.catalogue.isGeneral(state) ? [] : ["abscissa"];
    const all = [...new Set(["n_unstable", ...besides, state.show])];
    this.resting = setTimeout(() => this.#want(state, all, state.show, true), REST);
  }

  stop() {
    clearTimeout(this.resting);
    this.waiting.ends();
    this.requests.stop();
  }

  #want(state, fields, show, rests = false) {
    try {
      // Curves of others are walked, which takes longer.
      const curved = rests || !this.catalogue.isGeneral(state);
      const text = this.text(state, rests ? CELLS : FEWER_CELLS, fields, curved);
      const logs = [state.x.log, state.y.log];
      const { set } = this;
      const fixed = besides(state, this.catalogue);
      this.waiting.goesOn("chart");
      this.requests.want({ text, show, logs, fixed, rests, set, number: ++this.number });
    } catch (error) {
      // What was asked before is not what is set.
      this.requests.stop();
      this.#failed(error);
    }
  }

  #failed(error) {
    this.waiting.ends();
    this.stale.fail();
    this.told.failed(error);
  }

  #show(chart, { show, logs, fixed, rests, set, number }) {
    if (number === this.number) this.waiting.ends();
    const found = chart.fields.find(({ name }) => name === show) ?? chart.fields[0];
    const field = { ...this.fields[found.name], ...found };
    const byName = Object.fromEntries(chart.fields.map(({ name, values }) => [name, values]));
    const [nx, ny] = chart.axes.map(({ values }) => values.length);
    const { shown, gaps } = found;
    const plane = {
      axes: chart.axes,
      ends: chart.axes.map((axis, i) => edges(axis, logs[i])),
      nx,
      ny,
      field,
      cells: field.values,
      status: byName.status,
      others: byName,
      counts: rests ? countsOf(chart) : null,
      shown,
      gaps,
      fixed,
      flags: (n) => flagsOf(plane, this.catalogue.flags, n),
      colours: coloursOf(field, shown),
      curves: curvesOf(chart),
      milliseconds: chart.milliseconds,
      rests,
    };
    this.told.shown(plane);
    this.stale.show(set);
  }
}
