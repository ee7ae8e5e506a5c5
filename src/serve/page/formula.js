// A friction law that is a formula: what it has for parameters, and the place of a mistake in it.

import { partsOf } from "./mistake.js";
import { quoted } from "./sweep.js";

const HEAD = '[friction]\nlaw = "formula"\nmu_k = ';

/**
 * Asks for the parameters of a formula, unless they are known.
 * @param {import("./catalogue.js").Catalogue} catalogue
 * @param {object} source
 * @param {string} formula
 * @param {AbortSignal} [signal]
 * @throws what is not understood of it, with its place in the text that was asked
 */
export async function learn(catalogue, source, formula, signal) {
  if (catalogue.formulas.has(formula)) return;
  const told = await source.formula(`${HEAD}${quoted(formula)}\n`, signal);
  catalogue.keep(formula, told);
}

/** Parts of a formula as it was asked: before, in and behind the place of a mistake. */
export function parted({ text, span }) {
  // Between the quotes; the head has as many bytes as letters.
  const begun = HEAD.length + 1;
  const place = span?.map((at) => at - begun) ?? [0, Infinity];
  return partsOf({ text: text.slice(begun, -2), span: place });
}
