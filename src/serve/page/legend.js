// What colours and marks of a chart mean, as slipmap tells it: beside the chart, and in files of it.

import { SPACING, tileOf } from "./cells.js";
import { make } from "./dom.js";

/** Writes the legend of a plane. */
export function tellLegend(list, { shown, marks }) {
  const { heading, scale, entries, fills, hatch } = shown;
  const key = JSON.stringify([heading, scale?.bar, scale?.ticks, entries, marks]);
  // Nothing is touched where nothing changes: this runs in every frame.
  if (list.dataset.key === key) return;
  list.dataset.key = key;
  const fillOf = (number) => fills.find(({ gap }) => gap === number);
  const items = entries.map(({ text, colour, gap }) =>
    make("li", {}, colour ? swatch(colour) : filled(fillOf(gap), hatch), text),
  );
  const seen = marks.map(({ mark, text }) => {
    return make("li", {}, make("i", { className: `box ${mark}` }), text);
  });
  const head = make("li", { className: "heading" }, heading.join(", "));
  list.replaceChildren(head, ...(scale ? [bar(scale)] : []), ...items, ...seen);
}

function swatch(colour) {
  const box = make("i", { className: "box" });
  box.style.background = colour;
  return box;
}

/** A box filled like cells without a value. */
function filled(fill, hatch) {
  const canvas = make("canvas", { className: "box", width: 3 * SPACING, height: 3 * SPACING });
  const [tile, size] = [tileOf(fill, hatch), 3 * SPACING];
  const pixel = (n) => {
    const [i, j] = [n % size, size - 1 - Math.floor(n / size)];
    return tile[(i % SPACING) * SPACING + (j % SPACING)];
  };
  const pixels = Uint32Array.from({ length: size * size }, (_, n) => pixel(n));
  const image = new ImageData(new Uint8ClampedArray(pixels.buffer), size, size);
  canvas.getContext("2d").putImageData(image, 0, 0);
  return canvas;
}

function bar({ bar: colours, ticks }) {
  const strip = make("span", { className: "strip" });
  strip.style.background = `linear-gradient(to right, ${colours.join(", ")})`;
  const numbers = ticks.map(({ part, text }) => {
    const number = make("span", {}, text);
    number.style.left = `${100 * part}%`;
    return number;
  });
  const row = make("span", { className: "places" }, ...numbers);
  return make("li", { className: "wide" }, make("span", { className: "bar" }, strip, row));
}

/** Sizes of a legend in a file, in CSS pixels. */
const [SIZE, LINE, BOX, STRIP, BAR] = [12, 20, 16, 18, 220];
/** How wide a character is, as a part of the size of its font, at most about. */
const CHARACTER = 0.6;

/** How wide the legend of a plane is in a file. */
export function widthOf({ shown, marks }) {
  const { heading, scale, entries } = shown;
  const wide = (text) => text.length * CHARACTER * SIZE;
  const boxed = [...entries, ...marks].map(({ text }) => BOX + 8 + wide(text));
  const ticks = (scale?.ticks ?? []).map(({ text }) => STRIP + 12 + wide(text));
  return Math.max(...heading.map(wide), ...boxed, ...ticks);
}

/** How high it is. */
export function heightOf({ shown, marks }) {
  const { heading, scale, entries } = shown;
  const rows = heading.length + entries.length + marks.length;
  return LINE * rows + (scale ? BAR + 1.5 * LINE : 0);
}

/** Draws the legend of a plane, with its upper left corner at a place. */
export function drawLegend(pen, { shown, marks }, [x, y]) {
  const { heading, scale, entries, fills, hatch } = shown;
  const [ink, rule] = [pen.colour("ink"), pen.colour("rule")];
  const say = (text, at) => pen.text(text, at, { colour: ink, align: "left", size: SIZE });
  let top = y;
  for (const line of heading) {
    say(line, [x, top + LINE / 2]);
    top += LINE;
  }
  if (scale) {
    const height = BAR / scale.bar.length;
    scale.bar.forEach((colour, i) => {
      const at = top + LINE / 2 + BAR - (i + 1) * height;
      // Each one reaches under the next one, which is drawn later, so that no gap shows.
      const more = i + 1 < scale.bar.length ? height : 0;
      pen.box({ x, y: at - more, w: STRIP, h: height + more }, { fill: colour });
    });
    pen.box({ x, y: top + LINE / 2, w: STRIP, h: BAR }, { stroke: rule });
    for (const { part, text } of scale.ticks) {
      const at = top + LINE / 2 + BAR * (1 - part);
      pen.line([x + STRIP, at, x + STRIP + 5, at], { colour: ink });
      say(text, [x + STRIP + 9, at]);
    }
    top += BAR + 1.5 * LINE;
  }
  const row = (text, draw) => {
    const box = { x, y: top + (LINE - BOX) / 2, w: BOX, h: BOX };
    draw(box);
    pen.box(box, { stroke: rule });
    say(text, [x + BOX + 8, top + LINE / 2]);
    top += LINE;
  };
  for (const { text, colour, gap } of entries) {
    const fill = fills.find((each) => each.gap === gap);
    row(text, (box) => {
      pen.box(box, { fill: colour ?? fill.ground });
      if (fill) drawLines(pen, box, fill.lines, hatch);
    });
  }
  for (const { mark, text } of marks) row(text, (box) => drawMark(pen, box, mark));
}

/** The lines over cells without a value, in a box. */
function drawLines(pen, box, lines, colour) {
  const { x, y, w, h } = box;
  const ends = {
    rising: (at) => [x + at - h, y + h, x + at, y],
    falling: (at) => [x + at - h, y, x + at, y + h],
    upright: (at) => [x + at, y, x + at, y + h],
    level: (at) => [x, y + at, x + w, y + at],
  };
  pen.within(box, () => {
    for (const line of lines) {
      for (let at = SPACING / 2; at < w + h; at += SPACING) pen.line(ends[line](at), { colour });
    }
  });
}

/** What the page itself puts over pixels. */
function drawMark(pen, { x, y, w, h }, mark) {
  const [light, dark] = mark === "dotted" ? ["#f6e8c3", "#1b1b1b"] : ["#f2f2f2", "#d0d0d0"];
  pen.box({ x, y, w, h }, { fill: light });
  const size = mark === "dotted" ? 2 : 4;
  for (let i = 0; i < w / size; i++) {
    for (let j = 0; j < h / size; j++) {
      if ((i + j) % 2 === 0) {
        pen.box({ x: x + i * size, y: y + j * size, w: size, h: size }, { fill: dark });
      }
    }
  }
}
