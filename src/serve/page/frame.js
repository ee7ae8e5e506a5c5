// A frame with axes around an area.

import { ticksOf, told } from "./scale.js";

/**
 * The area inside of a frame, in CSS pixels.
 * @param {{width: number, height: number}} size
 */
export function areaWithin(
  { width, height },
  { left = 64, right = 16, top = 10, bottom = 46 } = {},
) {
  const [w, h] = [Math.max(1, width - left - right), Math.max(1, height - top - bottom)];
  return { x: left, y: top, w, h };
}

/** The title of an axis: its symbol, what its ticks are counted from, and its unit if it has one. */
export function titleOf({ symbol, unit }, origin = 0) {
  const sign = origin > 0 ? "−" : "+";
  const what = origin === 0 ? symbol : `${symbol} ${sign} ${told(Math.abs(origin), 17)}`;
  return !unit || unit === "1" ? what : `${what} (${unit})`;
}

/** How wide a character is, as a part of the size of its font, at most about. */
const CHARACTER = 0.62;
const SIZE = 13;

/** Where values lie in an area: x to the right, y upwards. */
export const placed = (area, [xs, ys], [x, y]) => [
  area.x + xs.part(x) * area.w,
  area.y + (1 - ys.part(y)) * area.h,
];

/**
 * Draws ticks, their numbers, and the titles of the axes, of which there may be only one.
 * @param {{symbol: string, unit: string}[]} axes
 */
export function drawFrame(pen, area, [xs, ys], axes) {
  const colour = pen.colour("ink");
  pen.box(area, { stroke: colour });
  const bottom = area.y + area.h;
  const across = ticksOf(xs, area.w / 80);
  for (const { part, text } of across.ticks) {
    const x = area.x + part * area.w;
    pen.line([x, bottom, x, bottom + 5], { colour });
    // A label at the end of the axis stays on the picture.
    const over = x + (text.length * CHARACTER * SIZE) / 2 > pen.width;
    const place = over ? pen.width : x;
    const align = over ? "right" : "center";
    pen.text(text, [place, bottom + 8], { colour, base: "top", size: SIZE, align });
  }
  const below = [area.x + area.w / 2, bottom + 27];
  pen.text(titleOf(axes[0], across.origin), below, { colour, base: "top", size: 14 });
  if (!axes[1]) return;
  const upwards = ticksOf(ys, area.h / 45);
  for (const { part, text } of upwards.ticks) {
    const y = area.y + (1 - part) * area.h;
    pen.line([area.x - 5, y, area.x, y], { colour });
    pen.text(text, [area.x - 8, y], { colour, align: "right" });
  }
  const side = [12, area.y + area.h / 2];
  pen.text(titleOf(axes[1], upwards.origin), side, { colour, turned: true, size: 14 });
}
