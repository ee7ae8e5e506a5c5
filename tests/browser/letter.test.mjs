// The letter's page, in a real browser: small and large, light and dark, printed; nothing is loaded, nothing is cut off.

import assert from "node:assert/strict";
import { join } from "node:path";
import { after, test } from "node:test";
import { pathToFileURL } from "node:url";
import { newFolder, openBrowser, openPage, picture, slipmap, violations } from "./support.mjs";

const file = join(newFolder(), "letter.html");
slipmap(["reproduce", "--quick", "--quiet", "-o", file]);
const link = pathToFileURL(file).href;
const browser = await openBrowser();
after(() => browser.close());

/** The page at a width and in a scheme, with all that it asked for. */
async function opened(width, colorScheme, more = {}) {
  const page = await openPage(browser, null, { width, colorScheme, ...more });
  const asked = [];
  page.on("request", (request) => asked.push(request.url()));
  await page.goto(link);
  return { page, asked };
}

/** The colours of the page, and what is wider than it. */
const seen = (page) =>
  page.evaluate(() => {
    const wide = [...document.querySelectorAll("body *")].filter((element) => {
      // What lies in a picture may be scrolled there.
      if (element.closest(".picture svg")) return false;
      return element.getBoundingClientRect().right > innerWidth + 1;
    });
    const { backgroundColor: paper, color: ink, fontSize } = getComputedStyle(document.body);
    return {
      paper,
      ink,
      fontSize,
      scrolls: document.documentElement.scrollWidth > innerWidth,
      wide: wide.map((element) => element.outerHTML.slice(0, 80)),
      pictures: [...document.querySelectorAll(".picture svg")].map((svg) => {
        const { width, height } = svg.getBoundingClientRect();
        return [width, height];
      }),
    };
  });

for (const width of [390, 1600]) {
  test(`at ${width} pixels nothing is asked for and nothing cut off, light and dark`, async () => {
    const colours = new Set();
    for (const scheme of ["light", "dark"]) {
      const { page, asked } = await opened(width, scheme);
      const found = await seen(page);
      assert.deepEqual(asked, [link]);
      assert.equal(found.scrolls, false);
      assert.deepEqual(found.wide, []);
      assert.equal(found.fontSize, "16px");
      assert.ok(found.pictures.length >= 12);
      // Their texts are of a readable size; on small screens they are scrolled by themselves.
      for (const size of found.pictures) assert.ok(size[0] >= 700 && size[1] >= 400, `${size}`);
      colours.add(`${found.paper} ${found.ink}`);
      assert.deepEqual(await violations(page), []);
      assert.deepEqual(page.faults, []);
      await picture(page, `letter-${width}-${scheme}`);
      await page.context().close();
    }
    assert.equal(colours.size, 2);
  });
}

test("every claim leads to what is behind it, also by keyboard, and scripts are not needed", async () => {
  const { page } = await opened(1000, "light", { javaScriptEnabled: false });
  const claims = await page.locator("section").count();
  assert.ok(claims > 20);
  for (const target of await page.locator("a[href^='#']").evaluateAll((links) =>
    links.map((link) => link.getAttribute("href")),
  )) {
    assert.equal(await page.locator(`[id="${target.slice(1)}"]`).count(), 1, target);
  }
  await page.locator("a[href='#velocity_limit']").first().focus();
  await page.keyboard.press("Enter");
  await page.waitForURL(/#velocity_limit$/);
  const limit = await page.locator("#velocity_limit").innerText();
  assert.match(limit, /-0\.725635939603/);
  assert.match(limit, /-0\.68/);
  assert.match(limit, /refined/);
  await page.context().close();
});

test("printed, pictures are light and within the sheet", async () => {
  const { page } = await opened(794, "dark");
  await page.emulateMedia({ media: "print", colorScheme: "light" });
  const found = await seen(page);
  assert.deepEqual(found.wide, []);
  for (const [width] of found.pictures) assert.ok(width <= 794, `${width}`);
  const pdf = await page.pdf({ format: "A4" });
  assert.ok(pdf.length > 50000);
  await page.context().close();
});
