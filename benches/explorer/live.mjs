// Frames of the live chart while a slider moves.

import { atRest } from "../support.mjs";
import { quantile, share, time } from "./measures.mjs";

/** Moves a slider in every frame, and notes when each frame and each chart is on the screen. */
const drag = (seconds) =>
  new Promise((done) => {
    const { plane, live } = window.slipmap;
    const slider = document.getElementById("p-mu_prime");
    const [between, latencies, frames] = [[], [], []];
    const { requests } = live;
    const [want, show] = [requests.want, requests.show];
    let [last, before, cells] = [null, null, 0];
    requests.want = (question) => want.call(requests, { ...question, asked: performance.now() });
    requests.show = (answer, question) => {
      show(answer, question);
      cells = plane.plane.nx * plane.plane.ny;
      // What is drawn now is on the screen with the next frame.
      requestAnimationFrame(() => {
        const now = performance.now();
        if (last !== null) between.push(now - last);
        latencies.push(now - question.asked);
        last = now;
      });
    };
    const begun = performance.now();
    const step = (now) => {
      if (before !== null) frames.push(now - before);
      before = now;
      const part = (now - begun) / 1000;
      slider.value = String(-0.45 + 0.35 * Math.sin(2 * part));
      slider.dispatchEvent(new Event("input", { bubbles: true }));
      if (part < seconds) {
        requestAnimationFrame(step);
      } else {
        Object.assign(requests, { want, show });
        done({ between, latencies, frames, seconds: part, cells });
      }
    };
    requestAnimationFrame(step);
  });

/** Drags for a while; what came of it. */
export async function dragged(page, seconds) {
  await page.evaluate(drag, 0.5);
  await atRest(page);
  const told = await page.evaluate(drag, seconds);
  await atRest(page);
  return told;
}

/** The cells of charts along the way of the slider, by rows from below, as peers want them. */
const charts = async ([count, from]) => {
  const { live, source, state } = window.slipmap;
  const { FEWER_CELLS } = await import("./live.js");
  const list = [];
  for (let k = from; k < Math.min(count, from + 8); k++) {
    const slope = -0.45 + 0.35 * Math.sin((2 * Math.PI * k) / count);
    const values = { ...state.values, mu_prime: slope };
    const chart = await source.chart(live.text({ ...state, values }, FEWER_CELLS));
    const [nx, ny] = chart.axes.map((axis) => axis.values.length);
    const { values: cells } = chart.fields.find(({ name }) => name === "n_unstable");
    const rows = new Uint8Array(nx * ny);
    for (let n = 0; n < rows.length; n++) rows[(n % ny) * nx + Math.floor(n / ny)] = cells[n];
    let text = "";
    for (let at = 0; at < rows.length; at += 4096) {
      text += String.fromCharCode(...rows.subarray(at, at + 4096));
    }
    list.push({ nx, ny, cells: btoa(text) });
  }
  return list;
};

/** Charts for the steps of a slider; the last step leads back to the first one. */
export async function chartsOfSteps(page, count) {
  const list = [];
  while (list.length < count) list.push(...await page.evaluate(charts, [count, list.length]));
  return list;
}

/** What several drags came to, as rows of a table. */
export function framesOf(told) {
  const between = told.flatMap((one) => one.between);
  const latencies = told.flatMap((one) => one.latencies);
  if (!between.length) return [["charts", "none or one in all the time"]];
  const seconds = told.reduce((sum, one) => sum + one.seconds, 0);
  return [
    ["charts", `${latencies.length} in ${seconds.toFixed(1)} s`],
    ["charts a second, median", (1000 / quantile(between, 0.5)).toFixed(1)],
    ["input to pixels, median", time(quantile(latencies, 0.5))],
    ["input to pixels, 95 %", time(quantile(latencies, 0.95))],
    ["under 50 ms", `${(100 * share(latencies, 50)).toFixed(1)} %`],
  ];
}
