// Pictures of a point: its roots in the complex plane, and its stable delays.

import { areaWithin, drawFrame, placed, titleOf } from "./frame.js";
import { CanvasPen } from "./pen.js";
import { Scale, told, withUnit } from "./scale.js";

/** What uPlot's options need of an element's style: colours by name, and axes with a grid. */
export function linesIn(target) {
  const style = getComputedStyle(target);
  const colour = (name) => style.getPropertyValue(`--${name}`).trim();
  const grid = { stroke: colour("grid"), width: 1 };
  const font = "12px system-ui, sans-serif";
  const axis = (more) => ({
    stroke: style.color,
    grid,
    ticks: { ...grid, size: 4 },
    gap: 2,
    font,
    labelFont: font,
    ...more,
  });
  return { colour, axis };
}

/** A range with some room around. */
function roomy(values, part = 0.08) {
  const [low, high] = [Math.min(...values), Math.max(...values)];
  const room = part * (high - low) || 0.5;
  return new Scale(low - room, high + room);
}

/** Draws the rightmost roots, the imaginary axis, and the line that no root is right of. */
export function drawRoots(canvas, { roots, certified_line: line, unit }) {
  const pen = new CanvasPen(canvas);
  const area = areaWithin(pen, { left: 56, bottom: 44 });
  const ends = [0, line ?? 0];
  const xs = roomy([...roots.map(([re]) => re), ...ends]);
  const height = Math.max(1e-3, ...roots.map(([, im]) => im));
  const scales = [xs, new Scale(-1.1 * height, 1.1 * height)];
  const at = (point) => placed(area, scales, point);
  const [zero] = at([0, 0]);
  pen.within(area, () => {
    pen.box({ ...area, x: zero }, { fill: pen.colour("unstable") });
    pen.line([zero, area.y, zero, area.y + area.h], { colour: pen.colour("ink"), width: 1.5 });
    if (line !== null && line !== undefined) {
      const [x] = at([line, 0]);
      pen.line([x, area.y, x, area.y + area.h], {
        colour: pen.colour("mark"),
        width: 2,
        dash: [6, 4],
      });
    }
    for (const [re, im] of roots) {
      for (const sign of im === 0 ? [1] : [1, -1]) {
        const fill = pen.colour(re > 0 ? "mark" : "calm");
        pen.disc(at([re, sign * im]), 4.5, { fill, stroke: pen.colour("paper"), width: 1 });
      }
    }
  });
  const axes = [
    { symbol: "Re λ", unit },
    { symbol: "Im λ", unit },
  ];
  drawFrame(pen, area, scales, axes);
}

/** How far along τ the stable delays are shown. */
function reach({ tau, stable_delays }) {
  const intervals = stable_delays ?? [];
  const ends = intervals.slice(0, 6).flatMap(([from, to]) => (to === null ? [from] : [from, to]));
  const near = ends.filter((end) => end <= Math.max(4 * tau, 25));
  return 1.15 * Math.max(tau, ...near, tau === 0 && near.length === 0 ? 1 : 0) || 1;
}

/** Draws the intervals of stable delays as a strip, with the delay of the point. */
export function drawDelays(canvas, point, axis) {
  const pen = new CanvasPen(canvas);
  const area = areaWithin(pen, { left: 20, right: 20, top: 26, bottom: 44 });
  const xs = new Scale(0, reach(point));
  const colour = pen.colour("ink");
  const x = (tau) => area.x + xs.part(tau) * area.w;
  pen.within({ ...area, y: 0, h: pen.height }, () => {
    const { stable_delays: intervals } = point;
    // Where nothing is known nothing is filled.
    if (intervals) pen.box(area, { fill: pen.colour("unstable") });
    for (const [from, to] of intervals ?? []) {
      const [left, right] = [x(from), x(Math.min(to ?? Infinity, 2 * xs.to))];
      pen.box({ ...area, x: left, w: Math.max(1, right - left) }, { fill: pen.colour("stable") });
    }
  });
  pen.box(area, { stroke: colour });
  const here = x(point.tau);
  pen.line([here, area.y - 8, here, area.y + area.h], { colour: pen.colour("mark"), width: 3 });
  const side = here > area.x + area.w / 2 ? "right" : "left";
  pen.text(withUnit(`τ = ${told(point.tau, 5)}`, axis.unit), [here, area.y - 10], {
    colour,
    align: side,
    base: "bottom",
  });
  for (const tick of xs.ticks(area.w / 70)) {
    pen.line([x(tick), area.y + area.h, x(tick), area.y + area.h + 5], { colour });
    pen.text(told(tick), [x(tick), area.y + area.h + 8], { colour, base: "top" });
  }
  pen.text(titleOf({ symbol: "τ", ...axis }), [area.x + area.w / 2, area.y + area.h + 26], {
    colour,
    base: "top",
    size: 14,
  });
}

/** A friction law: μ_K over v, and where the block slides. */
export function drawLaw(canvas, law) {
  const pen = new CanvasPen(canvas);
  const area = areaWithin(pen, { left: 52, bottom: 44 });
  const at = law.at ? [law.at.mu_k] : [];
  const scales = [new Scale(0, law.v[law.v.length - 1]), roomy([0, law.mu_s, ...law.mu_k, ...at])];
  pen.within(area, () => {
    const [x, y] = placed(area, scales, [0, law.mu_s]);
    pen.disc([x + 1, y], 5, { fill: pen.colour("mark") });
    const line = law.v.flatMap((v, i) => placed(area, scales, [v, law.mu_k[i]]));
    pen.line(line, { colour: pen.colour("calm"), width: 2 });
    if (!law.at) return;
    const here = placed(area, scales, [law.at.v0, law.at.mu_k]);
    pen.disc(here, 5, { stroke: pen.colour("ink"), width: 2 });
  });
  const axes = [
    { symbol: "v", unit: law.unit_v },
    { symbol: "μ_K; dot: μ_S", unit: "1" },
  ];
  drawFrame(pen, area, scales, axes);
}

/** The scales of a phase plane that hold a motion and its start. */
export function phaseScales({ a, x_dot: u }, start) {
  const ends = (values, more) => {
    let [low, high] = [more, more];
    for (const value of values) {
      if (value < low) low = value;
      if (value > high) high = value;
    }
    return [low, high];
  };
  return [roomy(ends(a, start[1])), roomy(ends(u, start[0]))];
}

/** Draws a motion in the phase plane, elongation and velocity, with its start. */
export function drawPhase(canvas, { a, x_dot: u }, start, scales, units) {
  const pen = new CanvasPen(canvas);
  const area = areaWithin(pen, { left: 60, bottom: 44 });
  const at = (point) => placed(area, scales, point);
  pen.within(area, () => {
    const points = new Float64Array(2 * a.length);
    for (let k = 0; k < a.length; k++) [points[2 * k], points[2 * k + 1]] = at([a[k], u[k]]);
    pen.line(points, { colour: pen.colour("calm"), width: 1.3 });
    const place = at([start[1], start[0]]);
    pen.disc(place, 9, { fill: pen.colour("mark"), stroke: pen.colour("halo"), width: 2 });
  });
  const axes = [
    { symbol: "elongation a", unit: units.a },
    { symbol: "velocity ẋ", unit: units.u },
  ];
  drawFrame(pen, area, scales, axes);
  return area;
}
