// The pictures of the page in README.md: `scripts/browser.sh pictures` makes them anew.

import { writeFileSync } from "node:fs";
import { join } from "node:path";
import {
  ROOT,
  atRest,
  newFolder,
  openBrowser,
  openPage,
  placeOf,
  serve,
  slipmap,
} from "./support.mjs";

const SIZE = { width: 1440, height: 900 };

const folder = newFolder();
const sweep = join(newFolder(), "planes.toml");
writeFileSync(
  sweep,
  `title = "Load control, slope after slope"
boundaries = true
[axes]
mu_prime = { from = -0.5, to = -0.05, points = 10 }
alpha_n = { from = -3.0, to = 1.0, points = 1000 }
tau = { from = 0.0, to = 10.0, points = 1000 }
`,
);
slipmap(["run", sweep, "-o", join(folder, "load_control.h5")]);

const browser = await openBrowser();
const server = await serve([folder]);

/** Of the top of the page, as large as the window. */
async function picture(page, name) {
  await atRest(page);
  await page.waitForFunction(() => {
    const vc = document.getElementById("vc");
    return vc.offsetParent === null || !/…/.test(vc.innerText);
  });
  await page.waitForTimeout(500);
  await page.screenshot({ path: join(ROOT, "doc", name) });
}

/** Clicks a point of the chart. */
async function click(page, point) {
  const { x, y } = await placeOf(page, point);
  await page.mouse.click(x, y);
}

const live = await openPage(browser, server.link, SIZE);
await live.locator("#law").selectOption("weakening");
await atRest(live);
await click(live, [-0.5, 3.2]);
await picture(live, "explorer.png");

const saved = await openPage(browser, server.link, { ...SIZE, colorScheme: "dark" });
await saved.getByRole("button", { name: /^Maps/ }).click();
await saved.getByRole("button", { name: "load_control.h5" }).click();
await saved.waitForFunction(() => window.slipmap.saved.map);
await atRest(saved);
await click(saved, [-1.2, 0.8]);
await picture(saved, "explorer_map.png");

await browser.close();
await server.end();
process.exit();
