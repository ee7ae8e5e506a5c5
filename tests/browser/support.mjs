// What the tests of the page and its benchmark share: a server, a browser, and ways to ask the page.

import { spawn, execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after } from "node:test";
import { chromium } from "playwright-core";

export const ROOT = process.env.SLIPMAP_ROOT;
export const PROGRAM = process.env.SLIPMAP_PROGRAM;

/** A folder that is gone when the process ends. */
export function newFolder() {
  const folder = mkdtempSync(join(tmpdir(), "slipmap-page-"));
  process.on("exit", () => rmSync(folder, { recursive: true, force: true }));
  return folder;
}

/** What slipmap prints. */
export const slipmap = (args, options = {}) =>
  execFileSync(PROGRAM, args, { encoding: "utf8", stdio: ["ignore", "pipe", "pipe"], ...options });

/** Starts a server; its link, the one for those who only look if there is such, and how to end it. */
export async function serve(args = [], port = 0) {
  const child = spawn(PROGRAM, ["serve", "--port", String(port), ...args], {
    stdio: ["ignore", "pipe", "ignore"],
  });
  const ended = new Promise((done) => child.once("exit", done));
  const wanted = args.includes("--submit") ? 2 : 1;
  const [link, look] = await new Promise((done, failed) => {
    let text = "";
    child.stdout.on("data", (part) => {
      text += part;
      const lines = text.split("\n").slice(0, -1);
      if (lines.length >= wanted) done(lines);
    });
    ended.then((code) => failed(new Error(`the server ended with ${code}`)));
  });
  process.on("exit", () => child.kill("SIGKILL"));
  const end = async () => {
    child.kill("SIGTERM");
    return ended;
  };
  return { link, look, end, child, token: link.split("token=")[1], port: Number(new URL(link).port) };
}

/** A headless Chromium that talks to nobody else; `more` are flags besides. */
export const openBrowser = (more = []) =>
  chromium.launch({
    executablePath: process.env.SLIPMAP_CHROMIUM,
    args: [
      "--no-sandbox",
      "--disable-gpu",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-default-apps",
      "--disable-sync",
      "--no-first-run",
      ...more,
    ],
  });

/** The browser and the server of a file of tests, until its last one. */
export async function opened(args = []) {
  const server = await serve(args);
  const browser = await openBrowser();
  after(async () => {
    await browser.close();
    await server.end();
  });
  return { browser, server };
}

/** Where pictures of the page are left to be looked at, if somebody wants to. */
export async function picture(page, name) {
  const folder = process.env.SLIPMAP_SCREENSHOTS;
  if (!folder) return;
  mkdirSync(folder, { recursive: true });
  await page.screenshot({ path: join(folder, `${name}.png`), fullPage: true });
}

/** What axe-core finds wrong, in words. */
export async function violations(page) {
  const axe = createRequire(import.meta.url).resolve("axe-core/axe.min.js");
  await page.evaluate(readFileSync(axe, "utf8"));
  const { violations: found } = await page.evaluate(() => window.axe.run());
  return found.flatMap(({ id, nodes }) => nodes.map(({ target }) => `${id}: ${target}`));
}

/**
 * A page of its own, with what went wrong in it.
 * @returns {Promise<import("playwright-core").Page & {faults: string[]}>}
 */
export async function openPage(browser, link, { width = 1280, height = 900, ...options } = {}) {
  const context = await browser.newContext({
    viewport: { width, height },
    acceptDownloads: true,
    permissions: ["clipboard-read", "clipboard-write"],
    ...options,
  });
  const page = await context.newPage();
  page.setDefaultTimeout(10000);
  page.faults = [];
  page.on("pageerror", (error) => page.faults.push(String(error)));
  page.on("console", (message) => {
    if (message.type() === "error") page.faults.push(message.text());
  });
  if (link) {
    await page.goto(link);
    await atRest(page);
  }
  return page;
}

/** Waits until the chart shows what is set, and nothing is asked for any more. */
export async function atRest(page) {
  await page.waitForFunction(() => {
    const { plane, live, saved } = window.slipmap ?? {};
    if (!plane?.plane) return false;
    const idle = (requests) => !requests.next && requests.underWay.size === 0;
    return plane.plane.rests && idle(live.requests) && idle(saved.windows);
  }, undefined, { timeout: 30000 });
}

/** Waits until everything about the point is there, too. */
export async function settled(page) {
  await atRest(page);
  await page.waitForFunction(() => {
    const { settling, panel } = window.slipmap;
    return !settling && panel.next && !panel.pending;
  });
}

/** Shows the view of an address, and waits for it. */
export async function show(page, fragment) {
  await page.evaluate((hash) => (location.hash = hash), fragment);
  await page.waitForTimeout(50);
  await settled(page);
}

/** Tries until nothing is thrown, for ten seconds. */
export async function eventually(check) {
  const until = Date.now() + 10000;
  for (;;) {
    try {
      return await check();
    } catch (error) {
      if (Date.now() > until) throw error;
      await new Promise((done) => setTimeout(done, 50));
    }
  }
}

/** The colour on the screen at a point of the chart, as [r, g, b]. */
export const colourAt = (page, points) =>
  page.evaluate((wanted) => {
    const { plane } = window.slipmap;
    const area = plane.area();
    const scale = window.devicePixelRatio;
    const context = plane.canvas.getContext("2d");
    return wanted.map(([x, y]) => {
      const at = [area.x + plane.view[0].part(x) * area.w, area.y + (1 - plane.view[1].part(y)) * area.h];
      const [px, py] = at.map((part) => Math.round(part * scale - 0.5));
      return Array.from(context.getImageData(px, py, 1, 1).data.slice(0, 3));
    });
  }, points);

/** Where a point of the chart is on the page. */
export const placeOf = (page, point) =>
  page.evaluate(([x, y]) => {
    const { plane } = window.slipmap;
    const [area, box] = [plane.area(), plane.canvas.getBoundingClientRect()];
    return {
      x: box.left + area.x + plane.view[0].part(x) * area.w,
      y: box.top + area.y + (1 - plane.view[1].part(y)) * area.h,
    };
  }, point);

/** Numbers in [0, 1) by chance from a seed. */
export function* chance(seed) {
  let state = seed >>> 0;
  for (;;) {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    yield state / 2 ** 32;
  }
}
