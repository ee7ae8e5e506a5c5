// The page without a server: static files, in which WebAssembly computes, in a real browser.

import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join } from "node:path";
import { after, test } from "node:test";
import { atRest, openPage, opened, slipmap } from "./support.mjs";

const FOLDER = process.env.SLIPMAP_STATIC_PAGE;
const TYPES = {
  ".html": "text/html",
  ".js": "text/javascript",
  ".css": "text/css",
  ".wasm": "application/wasm",
};

const { browser, server } = await opened();
const files = createServer((request, response) => {
  const name = request.url === "/" ? "index.html" : request.url.slice(1).replace(/[?#].*/, "");
  const file = join(FOLDER, name);
  if (!/^[\w.-]+$/.test(name) || !existsSync(file)) return response.writeHead(404).end();
  response.setHeader("Content-Type", TYPES[extname(name)] ?? "text/plain");
  return response.end(readFileSync(file));
});
await new Promise((done) => files.listen(0, "127.0.0.1", done));
after(() => {
  files.closeAllConnections();
  files.close();
});

const address = () => `http://127.0.0.1:${files.address().port}/`;

/** What the page shows: cells, curves, and the words about a point. */
const shown = (page) =>
  page.evaluate(async () => {
    const { plane } = window.slipmap.plane;
    const hash = async (numbers) => {
      const bytes = new Uint8Array(numbers.buffer, numbers.byteOffset, numbers.byteLength);
      const digest = await crypto.subtle.digest("SHA-256", bytes.slice());
      return Array.from(new Uint8Array(digest), (b) => b.toString(16).padStart(2, "0")).join("");
    };
    return {
      cells: await hash(plane.cells),
      abscissas: await hash(plane.others.abscissa),
      // Colours, scales and words of the legend.
      shown: plane.shown,
      legend: document.getElementById("legend").innerText,
      curves: await Promise.all(plane.curves.map(({ values }) => hash(values))),
      words: document.getElementById("point").innerText,
      vc: document.getElementById("vc").innerText,
    };
  });

const VIEW =
  "#v=1&control=load&x=alpha_n,-6,1&y=tau,0,8&v0=0.3&mu0=0.5&v_s=0.5&law=weakening&at=-2,1.5";

test("it shows, bit by bit, what the server's page shows", async () => {
  const all = [];
  for (const link of [address(), server.link]) {
    const page = await openPage(browser, link);
    await page.goto(link.replace(/\?.*/, "") + VIEW);
    await page.reload();
    await atRest(page);
    await page.waitForFunction(() => /ends by/.test(document.getElementById("vc").innerText));
    all.push(await shown(page));
    assert.deepEqual(page.faults, []);
  }
  assert.deepEqual(all[0], all[1]);
  assert.ok(all[0].curves.length > 2);
});

test("it computes where one points, and has no maps", async () => {
  const page = await openPage(browser, address());
  assert.ok(await page.getByRole("button", { name: /^Maps/ }).isHidden());
  const slider = page.locator("#p-mu_prime");
  await slider.focus();
  for (let k = 0; k < 20; k++) await page.keyboard.press("ArrowLeft");
  await atRest(page);
  const slope = await slider.inputValue();
  await page.waitForFunction(
    (text) => document.getElementById("command").value.includes(text),
    `--mu-prime=${slope}`,
  );
  const command = (await page.locator("#command").inputValue()).split(" ").slice(1);
  const told = JSON.parse(slipmap([...command, "--json"]));
  const words = await page.locator("#point").innerText();
  assert.ok(words.includes(String(Number(Math.abs(told.abscissa).toPrecision(6)))), words);
  assert.deepEqual(page.faults, []);
});

test("a link to a map says that maps need a server", async () => {
  const page = await openPage(browser, address());
  await page.evaluate(() => (location.hash = "#v=1&map=0123456789abcdef"));
  await page.locator("#problem", { hasText: "slipmap serve" }).waitFor();
  assert.ok(await page.locator("#origin").isHidden());
  await page.getByRole("button", { name: "Live chart" }).click();
  await atRest(page);
  assert.equal(await page.locator("#origin").innerText(), "computed now");
  assert.deepEqual(page.faults, []);
});
