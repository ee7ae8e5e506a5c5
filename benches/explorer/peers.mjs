// Heat maps of others at the same work as the live chart, in the same browser.
//
// They are given every chart before the clock starts, and draw no curves: they need not compute
// anything, as slipmap does for each of its charts.

import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { openPage } from "../support.mjs";
import { median, quantile, time } from "./measures.mjs";

/** Where `scripts/browser.sh bench --peers` installs them. */
const FOLDER = process.env.SLIPMAP_PEERS ?? "";
/** Cells of an array that stays while it is looked at. */
const STILL = [5000, 4000];
const STEPS = 12;
/** How long a peer may take for its first picture, in milliseconds: without WebGL there is none. */
const PATIENCE = 30000;
/** Charts that may be under way at once: as many as slipmap's page allows itself. */
const MOST = 2;

const versionOf = (name) =>
  JSON.parse(readFileSync(join(FOLDER, "node_modules", name, "package.json"), "utf8")).version;

const PEERS = [
  {
    name: "plotly.js heat map",
    of: "plotly.js-dist-min",
    scripts: ["node_modules/plotly.js-dist-min/plotly.min.js", "plotly.js"],
    styles: [],
  },
  {
    name: "h5web HeatmapVis",
    of: "@h5web/lib",
    scripts: ["bundled/h5web.js"],
    styles: ["bundled/h5web.css"],
    still: true,
  },
];

/** Those that are installed; `missing` is told of the others. */
export function installedPeers(missing) {
  return PEERS.filter((peer) => {
    const there = FOLDER && [...peer.scripts, ...peer.styles].every((path) =>
      existsSync(join(FOLDER, path)));
    if (!there) missing(`${peer.name}: could not be installed, so it is not measured`);
    return there;
  }).map((peer) => ({ ...peer, version: versionOf(peer.of) }));
}

/** An empty page with a box of a size, and a peer in it. */
async function pageOf(browser, peer, [width, height]) {
  const page = await openPage(browser, null);
  const box = `width:${width}px;height:${height}px`;
  await page.setContent(`<!doctype html><title>peer</title><div id="chart" style="${box}"></div>`);
  for (const path of peer.styles) await page.addStyleTag({ path: join(FOLDER, path) });
  for (const path of peer.scripts) await page.addScriptTag({ path: join(FOLDER, path) });
  return page;
}

/** What is promised, or an error where it takes too long. */
function soon(promise) {
  let timer = null;
  const late = new Promise((_, failed) => {
    timer = setTimeout(() => failed(new Error("nothing was drawn")), PATIENCE);
  });
  return Promise.race([promise, late]).finally(() => clearTimeout(timer));
}

/** A page of a peer that shows the first chart, in a box as large as slipmap's. */
export async function openPeer(browser, peer, charts, { size, x, y }) {
  const page = await pageOf(browser, peer, size);
  await page.evaluate(() => (window.given = []));
  for (const chart of charts) {
    await page.evaluate((text) => {
      window.given.push(Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)));
    }, chart.cells);
  }
  const { nx, ny } = charts[0];
  await soon(page.evaluate((about) => window.peer.begin({ ...about, charts: window.given }),
    { nx, ny, x, y }));
  return page;
}

/**
 * Asks for another chart in every frame, as a slider does that is dragged; like slipmap's page, for
 * none while as many as `most` are under way.
 */
const steps = ([seconds, most]) =>
  new Promise((done) => {
    const { peer, given } = window;
    const [between, latencies] = [[], []];
    const begun = performance.now();
    let [last, number, drawn] = [null, 0, 0];
    const ask = async () => {
      const [asked, own] = [performance.now(), ++number];
      // One that is overtaken by a later one is never drawn, and not counted.
      await peer.show(own % given.length);
      drawn = Math.max(drawn, own);
      // What is drawn now is on the screen with the next frame.
      requestAnimationFrame(() => {
        const now = performance.now();
        if (last !== null) between.push(now - last);
        latencies.push(now - asked);
        last = now;
      });
    };
    const step = (now) => {
      const part = (now - begun) / 1000;
      if (part >= seconds) return done({ between, latencies, seconds: part });
      if (number - drawn < most) ask();
      return requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  });

/** Moves a peer's slider for a while. */
export async function steppedPeer(page, seconds) {
  await page.evaluate(steps, [0.5, MOST]);
  return page.evaluate(steps, [seconds, MOST]);
}

/** Draws an array that stays, and waits for the first picture of it. */
const drawStill = ([nx, ny]) => {
  const cells = new Float32Array(nx * ny);
  for (let j = 0, n = 0; j < ny; j++) {
    for (let i = 0; i < nx; i++, n++) cells[n] = Math.floor(8 + 8 * Math.sin((i * j) / 1e6));
  }
  let current = null;
  for (const type of ["wheel", "pointermove"]) {
    window.addEventListener(type, (event) => {
      if (type === "pointermove" && event.buttons === 0) return;
      if (current) current.begun ??= event.timeStamp;
    }, { capture: true, passive: true });
  }
  window.nextView = () => {
    window.viewed = new Promise((done) => (current = { begun: null, done }));
  };
  window.nextView();
  current.begun = performance.now();
  window.peer.still({ nx, ny, cells, most: 16 }, () => {
    if (!current?.begun) return;
    current.done(performance.now() - current.begun);
    current = null;
  });
  return window.viewed;
};

/** One view of an array that stays; null where the input changes nothing. */
async function viewed(page, act) {
  await page.evaluate(() => window.nextView());
  await act();
  return page.evaluate(() => {
    const late = new Promise((done) => setTimeout(done, 3000, null));
    return Promise.race([window.viewed, late]);
  });
}

/** Views of a large array that h5web has in memory, as rows of a table. */
export async function stillOf(browser, peer, size) {
  const page = await pageOf(browser, peer, size);
  const first = await soon(page.evaluate(drawStill, STILL));
  const middle = [0.6 * size[0], 0.45 * size[1]];
  await page.mouse.move(...middle);
  const list = [];
  const zoom = async (delta) => {
    for (let k = 0; k < STEPS; k++) list.push(await viewed(page, () => page.mouse.wheel(0, delta)));
  };
  await zoom(-150);
  for (let k = 0; k < STEPS; k++) {
    await page.mouse.move(...middle);
    await page.mouse.down();
    const way = k % 2 ? -1 : 1;
    const to = [middle[0] + 40 * way, middle[1] - 25 * way];
    list.push(await viewed(page, () => page.mouse.move(...to)));
    await page.mouse.up();
  }
  await page.mouse.move(...middle);
  await zoom(150);
  await page.context().close();
  const seen = list.filter((ms) => ms !== null);
  if (seen.length < list.length / 2) {
    return [["first view", time(first)], ["views", `only ${seen.length} of ${list.length} inputs`]];
  }
  return [
    ["first view of the array", time(first)],
    ["a view of it, median", time(median(seen))],
    ["a view of it, 95 %", `${time(quantile(seen, 0.95))} (${seen.length} views)`],
  ];
}

export const stillTitle = `an array of ${STILL.join(" × ")} that is in memory`;
