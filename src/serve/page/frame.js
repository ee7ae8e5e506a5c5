// A frame with axes around an area.

import { tickText } from "./scale.js";

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

/** The title of an axis: its symbol, and its unit if it has one. */
export const titleOf = ({ symbol, unit }) =>
  !unit || unit === "1" ? symbol : `${symbol} (${unit})`;

/** Where values lie in an area: x to the right, y upwards. */
export const placed = (area, [xs, ys], [x, y]) => [
  area.x + xs.part(x) * area.w,
  area.y + (1 - ys.part(y)) * area.h,
];

/**
 * Draws ticks, their numbers, and the titles of both axes.
 * @param {{symbol: string, unit: string}[]} axes
 */
export function drawFrame(pen, area, [xs, ys], axes) {
  const colour = pen.colour("ink");
  pen.box(area, { stroke: colour });
  const bottom = area.y + area.h;
  const ticks = (scale, most) => {
    const list = scale.ticks(Math.max(2, most));
    return list.map((t) => [scale.part(t), tickText(t, Math.abs(scale.to - scale.from))]);
  };
  for (const [part, text] of ticks(xs, area.w / 80)) {
    const x = area.x + part * area.w;
    pen.line([x, bottom, x, bottom + 5], { colour });
    pen.text(text, [x, bottom + 8], { colour, base: "top" });
  }
  pen.text(titleOf(axes[0]), [area.x + area.w / 2, bottom + 27], { colour, base: "top", size: 14 });
  for (const [part, text] of ticks(ys, area.h / 45)) {
    const y = area.y + (1 - part) * area.h;
    pen.line([area.x - 5, y, area.x, y], { colour });
    pen.text(text, [area.x - 8, y], { colour, align: "right" });
  }
  const side = [12, area.y + area.h / 2];
  pen.text(titleOf(axes[1]), side, { colour, turned: true, size: 14 });
}
