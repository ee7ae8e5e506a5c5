// What colours and marks of a chart mean, in words.

import { lacking, valueOf } from "./cells.js";
import { make } from "./dom.js";

/** Writes the legend of a plane. */
export function tellLegend(list, plane) {
  const legend = meanings(plane);
  const items = Array.isArray(legend) ? legend.map(swatch) : bar(legend);
  const marks = plane.marks.map(({ mark, text }) => {
    return make("li", {}, make("i", { className: `box ${mark}` }), text);
  });
  const key = JSON.stringify([legend, marks.map((item) => item.textContent)]);
  // Nothing is touched where nothing changes: this runs in every frame.
  if (list.dataset.key === key) return;
  list.dataset.key = key;
  list.replaceChildren(...items, ...marks);
}

/** What the colours of a plane mean; of many classes, those that are to be seen. */
function meanings(plane) {
  const { colours, cells } = plane;
  const { legend } = colours;
  if (!colours.classOf) return legend;
  const seen = new Set();
  let last = null;
  for (let n = 0; n < cells.length; n++) {
    if (lacking(plane, n)) continue;
    const value = valueOf(plane, n);
    if (!Object.is(value, last)) seen.add(colours.classOf(value));
    last = value;
  }
  const none = seen.has(NaN) ? [{ colour: colours.noValue, text: "no value" }] : [];
  return [...legend.filter((_, kind) => seen.has(kind)), ...none];
}

function swatch({ colour, text }) {
  const box = make("i", { className: "box" });
  box.style.background = colour;
  return make("li", {}, box, text);
}

function bar({ stops, ticks, words, none }) {
  const strip = make("span", { className: "strip" });
  strip.style.background = `linear-gradient(to right, ${stops.join(", ")})`;
  const numbers = make("span", { className: "ticks" }, ...ticks.map((t) => make("span", {}, t)));
  const whole = make("span", { className: "bar" }, strip, numbers);
  const item = make("li", { className: "wide" }, words[0], whole, words[1]);
  return [item, swatch({ colour: none, text: "no value" })];
}
