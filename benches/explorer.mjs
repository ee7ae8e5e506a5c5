// How fast the page is in a headless Chromium: frames of the live chart while a slider moves, and views of a map of 10⁹ cells.
// `scripts/browser.sh bench [--seconds N] [--map FOLDER]` runs it.

import { parseArgs } from "node:util";
import { atRest, openBrowser, openPage, serve } from "./support.mjs";

const { values: options } = parseArgs({
  options: { seconds: { type: "string", default: "8" }, map: { type: "string" } },
});

const sorted = (list) => [...list].sort((a, b) => a - b);
const quantile = (list, part) => {
  const all = sorted(list);
  return all[Math.min(all.length - 1, Math.floor(part * all.length))];
};

/** Moves a slider in every frame, and notes when each chart is on the screen. */
const drag = (seconds) =>
  new Promise((done) => {
    const { plane, live } = window.slipmap;
    const slider = document.getElementById("p-mu_prime");
    const [frames, latencies] = [[], []];
    const { requests } = live;
    const [want, show] = [requests.want, requests.show];
    requests.want = (question) => want.call(requests, { ...question, asked: performance.now() });
    requests.show = (answer, question) => {
      show(answer, question);
      // What is drawn now is on the screen with the next frame.
      requestAnimationFrame(() => {
        const now = performance.now();
        frames.push(now);
        latencies.push(now - question.asked);
      });
    };
    const begun = performance.now();
    const step = (now) => {
      const part = (now - begun) / 1000;
      slider.value = String(-0.45 + 0.35 * Math.sin(2 * part));
      slider.dispatchEvent(new Event("input", { bubbles: true }));
      if (part < seconds) {
        requestAnimationFrame(step);
      } else {
        Object.assign(requests, { want, show });
        done({ frames, latencies, cells: plane.plane.nx * plane.plane.ny });
      }
    };
    requestAnimationFrame(step);
  });

const browser = await openBrowser();
const server = await serve(options.map ? [options.map] : []);
const page = await openPage(browser, server.link);
await page.evaluate(drag, 1);
await atRest(page);
const { frames, latencies, cells } = await page.evaluate(drag, Number(options.seconds));
const between = frames.slice(1).map((at, i) => at - frames[i]);
console.log(`live chart, ${cells} cells, ${frames.length} charts in ${options.seconds} s`);
console.log(`  charts a second, median     ${(1000 / quantile(between, 0.5)).toFixed(1)}`);
console.log(`  input to pixels, median     ${quantile(latencies, 0.5).toFixed(1)} ms`);
console.log(`  input to pixels, 95 %       ${quantile(latencies, 0.95).toFixed(1)} ms`);
console.log(`  under 50 ms                 ${((100 * latencies.filter((ms) => ms < 50).length) / latencies.length).toFixed(1)} %`);
if (page.faults.length) console.log(page.faults.join("\n"));
await browser.close();
await server.end();
