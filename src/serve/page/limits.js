// Limits of the actuators: off at first, each with a slider once it is on.

import { element, make } from "./dom.js";

/**
 * Makes the form of the limits.
 * @param {object} state see state.js
 * @param {import("./catalogue.js").Catalogue} catalogue
 * @param {(name: string) => HTMLElement} slider
 * @param {() => void} changed a limit was switched on or off
 */
export function buildLimits(state, catalogue, slider, changed) {
  const names = catalogue.moves(state) ? catalogue.folded("limits") : [];
  element("limits-sliders").closest("details").hidden = names.length === 0;
  const rows = names.map((name) => {
    if (name in state.values) return make("div", {}, check(name, true), slider(name));
    return check(name, false);
  });
  element("limits-sliders").replaceChildren(...rows);

  function check(name, on) {
    const { symbol, long_name: text, page } = catalogue.about(name);
    const box = make("input", { type: "checkbox", id: `on-${name}`, checked: on });
    box.addEventListener("change", () => {
      if (box.checked) state.values[name] = page.first;
      else delete state.values[name];
      changed();
    });
    const words = on ? ` ${symbol} limits it` : ` ${symbol}, ${text}`;
    return make("p", { className: "check" }, make("label", {}, box, words));
  }
}
