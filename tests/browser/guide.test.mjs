// The guide as mdBook makes it: on a phone no page is wider than it, links lead to pages, formulas are drawn, and nothing is
// asked of other machines.

import assert from "node:assert/strict";
import { existsSync, readdirSync } from "node:fs";
import { join } from "node:path";
import test from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import { openBrowser } from "./support.mjs";

const GUIDE = process.env.SLIPMAP_GUIDE;
// The contents by themselves, and a page that only a server shows.
const LEFT_OUT = ["toc.html", "404.html"];

test("every page of the guide fits a phone and is whole", async () => {
  const names = readdirSync(GUIDE, { recursive: true }).filter((name) => name.endsWith(".html") && !LEFT_OUT.includes(name));
  assert.ok(names.length > 40, `${names.length} pages`);
  const browser = await openBrowser();
  try {
    const page = await browser.newPage({ viewport: { width: 390, height: 844 } });
    let wrong = [];
    page.on("request", (request) => request.url().startsWith("file:") || wrong.push(`asks for ${request.url()}`));
    // Icons that are still under way when the next page is asked for are no failure.
    page.on("requestfailed", (request) => /ABORTED/.test(request.failure().errorText) || wrong.push(`without ${request.url()}`));
    page.on("pageerror", (error) => wrong.push(error.message));
    let formulas = 0;
    for (const name of names) {
      wrong = [];
      await page.goto(pathToFileURL(join(GUIDE, name)).href);
      const seen = await page.evaluate(() => ({
        // What holds the text scrolls by itself: the page does not get wider.
        width: Math.max(...[...document.querySelectorAll("html, .page, .content, main")].map((box) => box.scrollWidth)),
        formulas: document.querySelectorAll(".katex").length,
        undrawn: document.querySelectorAll(".katex-error, code.language-math").length,
        links: [...document.querySelectorAll("main a[href]")].map((link) => link.href.split("#")[0]),
        pictures: [...document.querySelectorAll("main img")].filter((image) => !image.naturalWidth).map((image) => image.src),
      }));
      formulas += seen.formulas;
      if (seen.width > 390) wrong.push(`${seen.width} pixels wide`);
      if (seen.undrawn) wrong.push(`${seen.undrawn} formulas are not drawn`);
      const local = new Set(seen.links.filter((link) => link.startsWith("file:")));
      for (const link of local) if (!existsSync(fileURLToPath(link))) wrong.push(`links to ${link}`);
      assert.deepEqual([...wrong, ...seen.pictures], [], name);
    }
    assert.ok(formulas > 50, `${formulas} formulas`);
  } finally {
    await browser.close();
  }
});
