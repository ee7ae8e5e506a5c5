// A table of what a chart shows: the cells nearest to a few values of both axes.

import { gapOf, lacking, valueOf, wordsOf } from "./cells.js";
import { make } from "./dom.js";
import { told } from "./scale.js";

/** Rows and columns of the table. */
const [ROWS, COLUMNS] = [9, 7];

/** Fills a table with cells of a plane, rows by y from the top; one row where there is no y. */
export function tellTable(table, plane, view) {
  const { axes, nx, ny, ends, field, shown } = plane;
  const places = (axis, n, most) => {
    const found = new Map();
    for (let k = 0; k < most; k++) {
      const value = view[axis].value(k / (most - 1));
      const pixel = Math.min(n - 1, Math.max(0, Math.floor(ends[axis].part(value) * n)));
      const cell = axes[axis].index?.[pixel] ?? pixel;
      if (!found.has(cell)) found.set(cell, { pixel, value: axes[axis].values?.[pixel] ?? value });
    }
    return [...found.values()];
  };
  const one = !axes[1];
  const columns = places(0, nx, COLUMNS);
  const rows = one ? [{ pixel: 0 }] : places(1, ny, ROWS).reverse();
  const head = columns.map(({ value }) => make("th", { scope: "col" }, told(value, 4)));
  const words = axes.map(({ symbol }) => symbol).reverse();
  const corner = make("th", { scope: "col" }, words.join(" \\ "));
  // Numbers of a scale have less digits here.
  const number = (n) => shown.scale && !lacking(plane, n) && !gapOf(plane, n);
  const finite = (n) => number(n) && Number.isFinite(valueOf(plane, n)) && valueOf(plane, n) !== 0;
  const text = (n) => (finite(n) ? told(valueOf(plane, n), 4) : wordsOf(plane, n));
  const body = rows.map((row) => {
    const found = columns.map(({ pixel }) => {
      const n = pixel * ny + row.pixel;
      return make("td", {}, text(n));
    });
    const name = one ? (field.short_name ?? field.name) : told(row.value, 4);
    return make("tr", {}, make("th", { scope: "row" }, name), ...found);
  });
  table.replaceChildren(
    make("caption", {}, `${field.long_name ?? field.name}, at some of the cells`),
    make("thead", {}, make("tr", {}, corner, ...head)),
    make("tbody", {}, ...body),
  );
}
