// A trace from a file: what is said of it, in the list and where it is shown.

import { element, terms } from "./dom.js";
import { told, withUnit } from "./scale.js";

/** What there is in a trace, in words. */
export const contentsOf = ({ samples, until, unit }) =>
  `${samples.toLocaleString("en")} samples until t = ${withUnit(told(until), unit)}`;

/** Whether a trace is shown; then nothing of a chart is. */
export const showsTrace = (shown) => element("main").classList.toggle("of-trace", shown);

/** Tells of a trace what is told of a map elsewhere. */
export function tellTrace({ name, title, trace, scalars }) {
  element("chart-title").textContent = title || name;
  element("map-title").textContent = title || name;
  terms(element("map-told"), [
    ["file", name],
    ["state", `trace, ${contentsOf(trace)}`],
    ["outcome", trace.outcome],
    ...scalars.map(({ symbol, value, unit }) => [symbol, withUnit(told(value), unit)]),
  ]);
}
