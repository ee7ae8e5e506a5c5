// A file of what is seen: title, fixed parameters, the plane and its legend, without the point.

import { element } from "./dom.js";
import { areaWithin } from "./frame.js";
import { drawLegend, heightOf, widthOf } from "./legend.js";
import { CanvasPen, SvgPen } from "./pen.js";
import { told, withUnit } from "./scale.js";

/** Sizes of texts, the distance between their lines, and room at the edges, in CSS pixels. */
const [TITLE, SMALL, LINE, ROOM] = [17, 12, 18, 16];
/** How wide a character is, as a part of the size of its font, at most about. */
const CHARACTER = 0.56;

/** Words in lines that are no longer than there is room for characters. */
function wrapped(words, most, between) {
  const lines = [];
  for (const word of words) {
    const longer = lines.length ? `${lines.at(-1)}${between}${word}` : "";
    if (longer && longer.length <= most) lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  return lines;
}

/** The colours of a file. */
const paper = () => getComputedStyle(element("paper"));

/** What stands where on a sheet. */
function sheetOf({ canvas, plane }, title) {
  const chart = { width: canvas.clientWidth, height: canvas.clientHeight };
  const width = chart.width + ROOM + widthOf(plane) + ROOM;
  const fits = (size) => Math.floor((width - 2 * ROOM) / (CHARACTER * size));
  const titles = [plane.from, title].filter(Boolean);
  const these = (plane.fixed ?? []).filter((parameter) => parameter.told !== false);
  const fixed = these.map(
    ({ symbol, value, unit }) => `${symbol} = ${withUnit(told(value), unit)}`,
  );
  const lines = [
    ...wrapped((titles[0] ?? "").split(" "), fits(TITLE), " ").map((text) => [text, TITLE]),
    ...titles.slice(1).map((text) => [text, SMALL]),
    ...wrapped(fixed, fits(SMALL), ", ").map((text) => [text, SMALL]),
  ].filter(([text]) => text);
  const head = lines.reduce((sum, [, size]) => sum + size + LINE - SMALL, ROOM / 2);
  const area = areaWithin(chart);
  area.y += head;
  const below = Math.max(chart.height, heightOf(plane) + 2 * ROOM);
  return { size: [width, head + below], lines, area, legend: [chart.width + ROOM, area.y] };
}

function draw(view, pen, { lines, area, legend }) {
  const colour = pen.colour("ink");
  let y = ROOM / 2;
  for (const [text, size] of lines) {
    pen.text(text, [ROOM, y], { colour, align: "left", base: "top", size });
    y += size + LINE - SMALL;
  }
  view.drawWith(pen, area, null);
  drawLegend(pen, view.plane, legend);
}

/**
 * The text of an SVG file.
 * @param {import("./plane.js").PlaneView} view
 * @param {string} [title]
 */
export function svgOf(view, title) {
  const sheet = sheetOf(view, title);
  const pen = new SvgPen(sheet.size, paper());
  draw(view, pen, sheet);
  return pen.file();
}

/** The bytes of a PNG file. */
export function pngOf(view, title) {
  const sheet = sheetOf(view, title);
  const canvas = document.createElement("canvas");
  draw(view, new CanvasPen(canvas, { size: sheet.size, style: paper() }), sheet);
  return new Promise((done) => canvas.toBlob(done, "image/png"));
}
