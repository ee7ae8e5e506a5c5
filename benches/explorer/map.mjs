// A map of 10⁹ cells in the page: its first view, slices across all of its chunks, other views.

import { mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { atRest, newFolder, openPage, placeOf, serve, slipmap } from "../support.mjs";
import { median, memoryOf, quantile, time } from "./measures.mjs";

const NAME = "billion-cells.h5";
const SWEEP = `title = "A billion cells"
fields = ["n_unstable"]
boundaries = false
[axes]
mu_prime = { from = -0.9, to = 0.1, points = 1000 }
alpha_v = { from = -1.6, to = 0.4, points = 1000 }
tau = { from = 0.0, to = 12.0, points = 1000 }
`;
/** Indices of the delay at which planes are looked at, far from each other. */
const DELAYS = [250, 750, 125];
const ROUNDS = 3;
/** Views of one kind: zooms in, moves, zooms out. */
const STEPS = 12;
/** Pixels that a drag moves the chart by; fewer than five are a click. */
const MOVED = [40, -25];

/** Whether a map of the list is the one to be measured. */
const fits = ({ state, axes, fields }) =>
  state === "complete" && fields.includes("n_unstable") &&
  axes.map(({ name, points }) => `${name} ${points}`).join() ===
    "mu_prime 1000,alpha_v 1000,tau 1000";

/** The maps of a folder as the server lists them, once it has looked at all of them. */
async function listed(folder) {
  const server = await serve([folder]);
  const headers = { Authorization: `Bearer ${server.token}` };
  const address = `http://127.0.0.1:${server.port}/api/v1/maps`;
  let maps = [];
  for (let tries = 0; tries < 40; tries++) {
    ({ maps } = await (await fetch(address, { headers })).json());
    if (!maps.some(({ state }) => state === "unknown")) break;
    await new Promise((done) => setTimeout(done, 250));
  }
  await server.end();
  return maps;
}

/** The name of the map in a folder; it is computed where there is none. */
export async function mapIn(folder) {
  mkdirSync(folder, { recursive: true });
  const found = (await listed(folder)).find(fits);
  if (found) return found.name;
  const sweep = join(newFolder(), "sweep.toml");
  writeFileSync(sweep, SWEEP);
  const begun = performance.now();
  slipmap(["run", sweep, "-o", join(folder, NAME), "--quiet"]);
  console.log(`computed a map of 10⁹ cells in ${time(performance.now() - begun)}`);
  return NAME;
}

/** Makes the page note when views are drawn that were asked for after an input. */
const watch = () => {
  const { windows } = window.slipmap.saved;
  const [want, show] = [windows.want, windows.show];
  const [known, own] = [new WeakSet(), new WeakSet()];
  let current = null;
  const noted = (event) => {
    if (!current || current.begun !== null) return;
    if (event.type === "pointermove" && event.buttons === 0) return;
    current.begun = event.timeStamp;
  };
  for (const type of ["click", "change", "input", "wheel", "pointermove"]) {
    window.addEventListener(type, noted, { capture: true, passive: true });
  }
  windows.want = (query) => {
    if (current?.begun && !known.has(query)) own.add(query);
    known.add(query);
    want.call(windows, query);
  };
  windows.show = (answer, query) => {
    show(answer, query);
    const now = current;
    if (!now?.begun || !own.has(query)) return;
    const unread = answer.bits ? answer.bits.reduce((sum, bit) => sum + ((bit & 2) >> 1), 0) : 0;
    const part = 1 - unread / answer.values.length;
    if (part === 0 && !answer.complete) return;
    // What is drawn now is on the screen with the next frame.
    requestAnimationFrame(() => {
      const after = performance.now() - now.begun;
      now.first ??= after;
      now.part ??= part;
      if (!answer.complete) return;
      const several = answer.bits ? answer.bits.reduce((sum, bit) => sum + (bit & 1), 0) : 0;
      const { first, part: share } = now;
      now.done({ first, part: share, complete: after, several, cells: answer.values.length });
    });
  };
  window.nextView = () => {
    window.viewed = new Promise((done) => (current = { begun: null, done }));
  };
};

/** From an input to the view that it asks for: its first pixels, and all of them. */
async function timed(page, act) {
  await page.evaluate(() => window.nextView());
  await act();
  const told = await page.evaluate(() => {
    const late = new Promise((done) => setTimeout(done, 60000, null));
    return Promise.race([window.viewed, late]);
  });
  if (!told) throw new Error("a view was not complete after 60 s");
  await atRest(page);
  return told;
}

/** A page that has just been opened, and its first view of the map. */
async function opened(browser, server, name) {
  const page = await openPage(browser, server.link);
  await page.evaluate(watch);
  await page.getByRole("button", { name: /^Maps/ }).click();
  const button = page.getByRole("button", { name, exact: true });
  await button.and(page.locator(":enabled")).waitFor();
  return [page, await timed(page, () => button.click())];
}

/** Planes at one delay, each of which cuts all chunks: the first one, then by the slider. */
async function slices(page) {
  const list = [await timed(page, () => page.locator("#map-y").selectOption("mu_prime"))];
  for (const at of DELAYS) {
    list.push(await timed(page, () => page.locator("#at-tau").fill(String(at))));
  }
  return list;
}

/** Views within the plane that is loaded: by the wheel into it, moved, and out of it again. */
async function views(page) {
  const list = [];
  const middle = await placeOf(page, await page.evaluate(() => {
    const { view } = window.slipmap.plane;
    return [view[0].value(0.6), view[1].value(0.45)];
  }));
  await page.locator("#chart").focus();
  await page.mouse.move(middle.x, middle.y);
  const zoom = async (delta) => {
    for (let k = 0; k < STEPS; k++) {
      list.push(await timed(page, () => page.mouse.wheel(0, delta)));
    }
  };
  await zoom(-150);
  for (let k = 0; k < STEPS; k++) {
    const way = k % 2 ? -1 : 1;
    await page.mouse.move(middle.x, middle.y);
    await page.mouse.down();
    const to = [middle.x + way * MOVED[0], middle.y + way * MOVED[1]];
    list.push(await timed(page, () => page.mouse.move(...to)));
    await page.mouse.up();
  }
  await page.mouse.move(middle.x, middle.y);
  await zoom(150);
  return list;
}

/** All that is measured, each time with a server and a page that know nothing yet. */
export async function measureMap(browser, folder) {
  const name = await mapIn(folder);
  const told = { first: [], exchanged: [], slid: [], views: [], memory: null, faults: [] };
  for (let round = 0; round < ROUNDS; round++) {
    const server = await serve([folder]);
    const [page, first] = await opened(browser, server, name);
    told.first.push(first);
    const [exchanged, ...slid] = await slices(page);
    told.exchanged.push(exchanged);
    told.slid.push(...slid);
    told.views.push(...await views(page));
    told.memory = memoryOf(server.child.pid);
    told.faults.push(...page.faults);
    await page.context().close();
    await server.end();
  }
  return told;
}

const both = (list, key) => {
  const all = list.map((one) => one[key]);
  return `${time(median(all))}, at most ${time(Math.max(...all))}`;
};

/** What the map came to, as rows of a table. */
export function rowsOfMap({ first, exchanged, slid, views: all, memory }) {
  const complete = all.map((one) => one.complete);
  const { cells, several } = exchanged[0];
  const part = Math.round(100 * median(exchanged.map((one) => one.part)));
  return [
    ["clicked to the first pixels", both(first, "first")],
    ["clicked to the whole first view", both(first, "complete")],
    ["axes exchanged: first pixels", `${both(exchanged, "first")}; ${part} % of them`],
    ["axes exchanged: complete", both(exchanged, "complete")],
    ["another delay: first pixels", both(slid, "first")],
    ["another delay: complete", both(slid, "complete")],
    ["pixels of such a plane", `${cells}, of which ${several} hide several values`],
    ["a view within it, median", time(median(complete))],
    ["a view within it, 95 %", `${time(quantile(complete, 0.95))} (${all.length} views)`],
    ["memory of the server, in the end", memory === null ? "not known on this system"
      : `${memory.megabytes.toFixed(0)} MB in ${memory.processes} processes`],
  ];
}
