// A table of what a chart shows: the cells nearest to a few values of both axes.

import { make } from "./dom.js";
import { told } from "./scale.js";

/** Rows and columns of the table. */
const [ROWS, COLUMNS] = [9, 7];

/** Fills a table with cells of a plane, rows by y from the top. */
export function tellTable(table, plane, view) {
  const { axes, nx, ny, ends, cells, colours, field } = plane;
  const places = (axis, n, most) =>
    Array.from({ length: most }, (_, k) => {
      const value = view[axis].value(k / (most - 1));
      const index = Math.min(n - 1, Math.max(0, Math.floor(ends[axis].part(value) * n)));
      return { index, value: axes[axis].values?.[index] ?? value };
    });
  const [columns, rows] = [places(0, nx, COLUMNS), places(1, ny, ROWS).reverse()];
  const head = columns.map(({ value }) => make("th", { scope: "col" }, told(value, 4)));
  const corner = make("th", { scope: "col" }, `${axes[1].symbol} \\ ${axes[0].symbol}`);
  const text = (value) => (Array.isArray(colours.legend) ? colours.name(value) : told(value, 4));
  const body = rows.map((row) => {
    const found = columns.map(({ index }) => make("td", {}, text(cells[index * ny + row.index])));
    return make("tr", {}, make("th", { scope: "row" }, told(row.value, 4)), ...found);
  });
  table.replaceChildren(
    make("caption", {}, `${field.long_name ?? field.name}, at some of the cells`),
    make("thead", {}, make("tr", {}, corner, ...head)),
    make("tbody", {}, ...body),
  );
}
