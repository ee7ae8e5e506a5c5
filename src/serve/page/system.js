// A system from a file, at a point: what is told of it besides its stability.

import { told } from "./scale.js";

/**
 * Rows of terms about the system of a point; null of the block.
 * @param {any} point as slipmap answers
 * @param {(value: number) => string} time a time in words
 * @returns {[string, string][] | null}
 */
export function aboutSystem(point, time) {
  const { system, parameters, memory, latency_margin: margin } = point;
  if (parameters === undefined) return null;
  const rows = Object.entries(parameters).map(([name, value]) => [name, told(value, 9)]);
  if (system) rows.unshift(["system", system]);
  if (memory !== null) {
    rows.push(["memory", told(memory, 9)], ["latency", time(point.latency)]);
    rows.push(["latency margin", margin === null ? "infinite, or not known" : time(margin)]);
  }
  if (!point.line_of_delays) rows.push(["other delays", "not known: the system depends on the delay"]);
  const { essential_abscissa: essential } = point;
  if (essential !== null) rows.push(["roots accumulate at", `Re λ = ${told(essential)}`]);
  return rows;
}
