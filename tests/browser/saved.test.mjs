// Maps from files in a real browser: what is on the screen is what the file holds and the command says.

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import {
  ROOT,
  PROGRAM,
  atRest,
  chance,
  colourAt,
  eventually,
  newFolder,
  openPage,
  opened,
  picture,
  placeOf,
  slipmap,
  violations,
} from "./support.mjs";

const folder = newFolder();
const asked = (args) => JSON.parse(slipmap([...args, "--json"]));

/** Makes a map in the folder from the text of a sweep. */
function makeMap(name, text) {
  const sweep = join(newFolder(), "sweep.toml");
  writeFileSync(sweep, text);
  slipmap(["run", sweep, "-o", join(folder, name)]);
}

const COUNTS = `title = "Three axes"
boundaries = true
[axes]
mu_prime = [-0.7, -0.5, -0.3, -0.1]
alpha_v = { from = -1.6, to = 0.4, points = 401 }
tau = { from = 0.0, to = 12.0, points = 301 }
`;
/** Ten times as many cells as there are pixels. */
const FINE = `[axes]
alpha_n = { from = -3.0, to = 1.0, points = 3000 }
tau = { from = 0.01, to = 10.0, points = 2500, spacing = "log" }
[fixed]
mu_prime = -0.3
`;
const RATES = `fields = ["n_unstable", "abscissa"]
[axes]
alpha_n = { from = -3.0, to = 1.0, points = 120 }
tau = { from = 0.01, to = 10.0, points = 100 }
[fixed]
mu_prime = -0.3
`;
const CRITICAL = `fields = ["vc", "outcome", "method"]
[axes]
alpha_v = { from = -1.0, to = -0.1, points = 12 }
tau = { from = 1.0, to = 5.0, points = 10 }
[friction]
law = "weakening"
mu0 = 0.5
v_s = 0.5
`;

makeMap("counts.h5", COUNTS);
makeMap("fine.h5", FINE);
makeMap("rates.h5", RATES);
makeMap("critical.h5", CRITICAL);
const whole = readFileSync(join(folder, "rates.h5"));
writeFileSync(join(folder, "broken.h5"), whole.subarray(0, 5000));
for (let at = 300; at < 3000; at += 7) whole[at] ^= 0x5a;
writeFileSync(join(folder, "odd.h5"), whole);
const { browser, server } = await opened([folder]);

/** Opens a map by the list. */
async function openMap(page, name) {
  await page.getByRole("button", { name: /^Maps/ }).click();
  await page.getByRole("button", { name, exact: true }).click();
  await page.waitForFunction((wanted) => window.slipmap.saved.map?.name === wanted, name);
  await atRest(page);
}

async function withMap(name, options) {
  const page = await openPage(browser, server.link, options);
  await page.getByRole("button", { name: /^Maps/ }).waitFor();
  await openMap(page, name);
  return page;
}

/** Pixels by chance, with the values of the cells that they show and what the page says is there. */
async function pixelsByChance(page, count, seed) {
  const numbers = chance(seed);
  const parts = Array.from({ length: count }, () => [numbers.next().value, numbers.next().value]);
  return page.evaluate((all) => {
    const { plane } = window.slipmap;
    const { ends, nx, ny, axes, cells, bits, colours } = plane.plane;
    return all.map((part) => {
      const cell = [Math.floor(part[0] * nx), Math.floor(part[1] * ny)];
      const n = cell[0] * ny + cell[1];
      const point = cell.map((index, i) => ends[i].value((index + 0.5) / [nx, ny][i]));
      const pixel = colours.pixel(cells[n]);
      return {
        point,
        values: cell.map((index, i) => axes[i].values[index]),
        value: cells[n],
        several: Boolean(bits[n] & 1),
        colour: [pixel & 255, (pixel >> 8) & 255, (pixel >> 16) & 255],
      };
    });
  }, parts);
}

/** What is seen is what the page says; returns the pixels that no curve or mark covers. */
async function seenPixels(page, count, seed) {
  const pixels = await pixelsByChance(page, count, seed);
  const seen = await colourAt(
    page,
    pixels.map(({ point }) => point),
  );
  const plain = pixels.filter(({ colour }, i) => colour.every((c, k) => c === seen[i][k]));
  assert.ok(plain.length > 0.85 * count, `${plain.length} of ${count}`);
  return plain;
}

test("the list says what there is, and what is damaged", async () => {
  const page = await openPage(browser, server.link);
  await page.getByRole("button", { name: "Maps (6)" }).click();
  const rows = await page.locator("#maps-table tbody tr").allInnerTexts();
  const of = (name) => rows.find((row) => row.startsWith(name));
  assert.match(
    of("counts.h5"),
    /complete.*μ′ \(4\) × α_v \(401\) × τ \(301\).*n_unstable.*482,804/s,
  );
  assert.match(of("broken.h5"), /damaged/);
  assert.match(of("odd.h5"), /damaged|complete/);
  const broken = page.getByRole("button", { name: "broken.h5" });
  assert.ok(await broken.isDisabled());
  assert.deepEqual(page.faults, []);
});

test("pixels of a map of three axes are what the command says", async () => {
  const page = await withMap("counts.h5");
  assert.equal(await page.locator("#origin").innerText(), "from the file");
  for (const index of [0, 2]) {
    await page.locator("#at-mu_prime").fill(String(index));
    await atRest(page);
    const slope = [-0.7, -0.5, -0.3, -0.1][index];
    for (const {
      values: [gain, tau],
      value,
    } of await seenPixels(page, 100, 20 + index)) {
      const flags = [`--mu-prime=${slope}`, `--alpha-v=${gain}`, `--tau=${tau}`];
      const { n_unstable: n, marginal } = asked(["point", ...flags]);
      assert.ok(n === value || marginal, `${flags}: ${n} and ${value}`);
    }
  }
  const curves = await page.evaluate(() => window.slipmap.plane.plane.curves.length);
  assert.ok(curves > 3, `${curves} curves`);
  assert.deepEqual(page.faults, []);
});

test("other axes, logarithmic ones, lines, and zooms of a fine map are true", async () => {
  const page = await withMap("fine.h5");
  const check = async (seed) => {
    for (const { values, value } of await seenPixels(page, 40, seed)) {
      const [gain, tau] =
        (await page.evaluate(() => window.slipmap.state.map.x)) === "tau"
          ? [values[1], values[0]]
          : values;
      const { n_unstable: n, marginal } = asked([
        "point",
        "--mu-prime=-0.3",
        `--alpha-n=${gain}`,
        `--tau=${tau}`,
      ]);
      assert.ok(n === value || marginal, `${values}: ${n} and ${value}`);
    }
  };
  await check(30);
  const several = () =>
    page.evaluate(() => window.slipmap.plane.plane.bits.filter((bit) => bit & 1).length);
  const hidden = await several();
  assert.ok(hidden > 100, `${hidden} pixels hide several values`);
  assert.match(await page.locator("#legend").innerText(), /hides several values/);
  await page.locator("#map-y").selectOption("alpha_n");
  await atRest(page);
  assert.equal(await page.locator("#map-x").inputValue(), "tau");
  await page.locator("#x-log").check();
  await atRest(page);
  await check(31);
  const at = await placeOf(page, [0.5, -1]);
  await page.locator("#chart").focus();
  await page.mouse.move(at.x, at.y);
  for (let k = 0; k < 12; k++) await page.mouse.wheel(0, -200);
  await atRest(page);
  await check(32);
  const left = await several();
  assert.ok(left < hidden, `${left} after ${hidden}`);
  await page.mouse.down();
  await page.mouse.move(at.x + 80, at.y + 40, { steps: 4 });
  await page.mouse.up();
  await atRest(page);
  await check(33);
  assert.deepEqual(page.faults, []);
});

test("curves lie where the counts change, whichever way the axes are", async () => {
  const page = await withMap("counts.h5");
  for (const x of ["alpha_v", "tau"]) {
    await page.locator("#map-x").selectOption(x);
    await atRest(page);
    await page.waitForFunction(() => window.slipmap.plane.plane.curves.length > 3);
    const points = await page.evaluate(() => {
      const { plane, view } = window.slipmap.plane;
      const all = plane.curves.flatMap(({ values }) =>
        Array.from({ length: values.length / 2 }, (_, k) => [values[2 * k], values[2 * k + 1]]),
      );
      const within = (part) => part > 0.02 && part < 0.98;
      return all.filter((point) => point.every((at, i) => within(view[i].part(at))));
    });
    assert.ok(points.length > 100, `${points.length} points`);
    const slope = await page.evaluate(() => {
      const { map, state } = window.slipmap.saved;
      return map.axes.find(({ name }) => name === "mu_prime").values[state.map.at.mu_prime];
    });
    const chosen = points.filter((_, k) => k % Math.ceil(points.length / 40) === 0);
    let changes = 0;
    for (const point of chosen) {
      const [gain, tau] = x === "tau" ? [point[1], point[0]] : point;
      const count = (by) => {
        const flags = [`--mu-prime=${slope}`, `--alpha-v=${gain + by}`, `--tau=${tau}`];
        return asked(["point", ...flags]).n_unstable;
      };
      if (count(-0.004) !== count(0.004)) changes++;
    }
    // Where a curve runs along the delay's axis, or two of them meet, it need not.
    assert.ok(changes >= 0.8 * chosen.length, `${changes} of ${chosen.length} along ${x}`);
  }
  assert.deepEqual(page.faults, []);
});

for (const width of [390, 1024, 1600]) {
  for (const colorScheme of ["light", "dark"]) {
    test(`a map at ${width} px, ${colorScheme}: no violations, nothing cut off`, async () => {
      const page = await withMap("rates.h5", { width, colorScheme, reducedMotion: "reduce" });
      await page.evaluate(() => {
        for (const part of document.querySelectorAll("details")) part.open = true;
      });
      await page.waitForTimeout(400);
      await picture(page, `map-${width}-${colorScheme}`);
      assert.deepEqual(await violations(page), []);
      const over = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
      assert.ok(over <= 0, `${over} px too wide`);
      assert.deepEqual(page.faults, []);
    });
  }
}

test("a cell that is hovered and clicked is that of the file, and computed anew beside it", async () => {
  const page = await withMap("rates.h5");
  await page.locator("#field").selectOption("abscissa");
  await atRest(page);
  const at = await placeOf(page, [-1, 0.8]);
  await page.mouse.move(at.x, at.y);
  const hover = await page.locator("#hover").innerText();
  assert.match(hover, /α_N = −(0\.9|1\.0).*τ = 0\.(7|8).*spectral abscissa −0\.\d+.*certified/);
  await page.mouse.click(at.x, at.y);
  await page.locator("#cell").evaluate((list) => (list.closest("details").open = true));
  await eventually(async () => {
    const command = await page.locator("#command").inputValue();
    const gain = Number(/--alpha-n=(\S+)/.exec(command)?.[1]);
    assert.ok(Math.abs(gain + 1) < 0.1, command);
    const told = asked(command.split(" ").slice(1));
    const held = await page.locator("#cell").innerText();
    const number = Number(told.abscissa.toPrecision(9)).toString().replace("-", "−");
    assert.ok(held.includes(number), `${held} has ${number}`);
    assert.match(held, /n_unstable\s+0/);
  });
  assert.match(await page.locator("#point").innerText(), /stable, 0 unstable roots/);
  assert.deepEqual(page.faults, []);
});

test("critical velocities, their ends, and slices along an axis", async () => {
  const page = await withMap("critical.h5");
  await page.locator("#field").selectOption("outcome");
  await atRest(page);
  assert.match(await page.locator("#legend").innerText(), /grazing/);
  await page.locator("#field").selectOption("vc");
  await atRest(page);
  await page.waitForFunction(() => !/…/.test(document.getElementById("vc").innerText));
  const vc = await page.locator("#vc").innerText();
  const cell = await page.evaluate(() => window.slipmap.plane.point);
  const found = asked([
    "vc",
    "--friction=weakening",
    "--mu0=0.5",
    "--v-s=0.5",
    `--alpha-v=${cell[0]}`,
    `--tau=${cell[1]}`,
  ]);
  assert.ok(vc.includes(found.vc === null ? "none" : String(Number(found.vc.toPrecision(6)))), vc);
  await page.locator("#slice-axis").selectOption("alpha_v");
  await page.waitForFunction(() => window.slipmap.saved.line?.data[0].length === 12);
  const line = await page.evaluate(() => window.slipmap.saved.line.data.map((list) => [...list]));
  assert.ok(
    line[0].every((x, i) => i === 0 || x > line[0][i - 1]),
    "in order",
  );
  assert.ok(line[1].some((x) => x > 0));
  assert.deepEqual(page.faults, []);
});

test("by keyboard: from the list to a cell and its neighbours", async () => {
  const page = await openPage(browser, server.link);
  const list = page.getByRole("button", { name: /^Maps/ });
  await list.waitFor();
  await list.focus();
  await page.keyboard.press("Enter");
  await page.getByRole("button", { name: "rates.h5" }).focus();
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => window.slipmap.saved.map?.name === "rates.h5");
  await atRest(page);
  await page.locator("#chart").focus();
  const index = () => page.evaluate(() => ({ ...window.slipmap.state.map.at }));
  const begun = await index();
  for (const key of ["ArrowRight", "ArrowRight", "ArrowUp"]) await page.keyboard.press(key);
  const moved = await index();
  assert.ok(moved.alpha_n > begun.alpha_n && moved.tau > begun.tau, JSON.stringify([begun, moved]));
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => /alpha-n=/.test(document.getElementById("command").value));
  // Where cells are large, a key still moves to the next one.
  for (let k = 0; k < 12; k++) await page.keyboard.press("+");
  await atRest(page);
  const before_ = await index();
  await page.keyboard.press("ArrowLeft");
  assert.equal((await index()).alpha_n, before_.alpha_n - 1);
});

test("the address of a map's view brings it back", async () => {
  const page = await withMap("counts.h5");
  await page.locator("#at-mu_prime").fill("1");
  await page.getByRole("button", { name: "Zoom in" }).click();
  await atRest(page);
  const at = await placeOf(page, [-0.5, 5]);
  await page.mouse.click(at.x, at.y);
  await page.waitForTimeout(500);
  const address = page.url();
  assert.match(address, /#v=1&map=[0-9a-f]{16}&field=n_unstable&x=alpha_v&y=tau/);
  const picture = () => page.evaluate(() => document.getElementById("chart").toDataURL());
  const seen = await picture();
  await page.goto("about:blank");
  await page.goto(address);
  await page.waitForFunction(() => window.slipmap?.saved.map);
  await atRest(page);
  await page.waitForTimeout(300);
  assert.ok((await picture()) === seen, "the same picture, pixel by pixel");
});

test("a map grows on the screen while it is computed", async () => {
  const sweep = join(newFolder(), "long.toml");
  writeFileSync(
    sweep,
    `fields = ["vc", "outcome"]
[axes]
alpha_n = { from = -3.0, to = 1.0, points = 90 }
tau = { from = 0.3, to = 5.0, points = 90 }
[friction]
law = "weakening"
mu0 = 0.5
v_s = 0.5
`,
  );
  const run = spawn(
    PROGRAM,
    ["run", sweep, "-o", join(folder, "long.h5"), "--threads", "1", "--save-every", "0.5"],
    { stdio: "ignore" },
  );
  const ended = new Promise((done) => run.once("exit", done));
  const page = await openPage(browser, server.link);
  await page.getByRole("button", { name: /^Maps/ }).click();
  await page.locator("#maps-table", { hasText: "long.h5" }).waitFor({ timeout: 20000 });
  const row = page.locator("tr", { hasText: "long.h5" });
  await page.waitForFunction(
    () => {
      const found = [...document.querySelectorAll("#maps-table tr")].find((r) =>
        /long/.test(r.innerText),
      );
      return (
        found && /running|complete/.test(found.innerText) && !found.querySelector("button").disabled
      );
    },
    undefined,
    { timeout: 20000 },
  );
  const first = await row.innerText();
  if (/running/.test(first)) {
    await row.getByRole("button").click();
    await page.waitForFunction(() => window.slipmap.plane.plane?.field.name === "outcome");
    const missing = () =>
      page.evaluate(() => window.slipmap.plane.plane.bits.filter((bit) => bit & 4).length);
    const begun = await missing();
    assert.ok(begun > 0, "some cells are not computed yet");
    run.kill("SIGTERM");
    await ended;
    await page.getByRole("button", { name: /^Maps/ }).click();
    await page.waitForFunction(
      () =>
        [...document.querySelectorAll("#maps-table tr")].some(
          (r) => /long/.test(r.innerText) && /interrupted/.test(r.innerText),
        ),
      undefined,
      { timeout: 15000 },
    );
    slipmap(["run", sweep, "-o", join(folder, "long.h5")]);
    await page.waitForFunction(() => window.slipmap.saved.map.state === "complete", undefined, {
      timeout: 30000,
    });
    await atRest(page);
    assert.equal(await missing(), 0);
  } else {
    assert.fail(`the run was over too soon to be looked at: ${first}`);
  }
  assert.deepEqual(page.faults, []);
});

test("a map that is gone or damaged while it is looked at is a message", async () => {
  const gone = join(folder, "gone.h5");
  writeFileSync(gone, readFileSync(join(folder, "rates.h5")));
  const page = await openPage(browser, server.link);
  await page.getByRole("button", { name: /^Maps/ }).click();
  await page.locator("#maps-table", { hasText: "gone.h5" }).waitFor({ timeout: 10000 });
  await page.getByRole("button", { name: "gone.h5" }).click();
  await atRest(page);
  writeFileSync(gone, "no map any more");
  await page.waitForTimeout(3000);
  await page.locator("#field").selectOption("abscissa");
  await page.waitForTimeout(1500);
  await page.getByRole("button", { name: "Live chart" }).click();
  await atRest(page);
  assert.equal(await page.locator("#origin").innerText(), "computed now");
});

test("a map's sweep file and its cells can be taken along", async () => {
  const page = await withMap("rates.h5");
  const take = async (name) => {
    const [download] = await Promise.all([
      page.waitForEvent("download"),
      page.getByRole("button", { name, exact: true }).click(),
    ]);
    return [download.suggestedFilename(), readFileSync(await download.path(), "utf8")];
  };
  assert.deepEqual(await take("Sweep file"), ["rates.toml", RATES]);
  const [name, csv] = await take("CSV");
  assert.equal(name, "rates.csv");
  const rows = csv
    .trim()
    .split("\n")
    .filter((line) => !line.startsWith("#"));
  assert.equal(rows[0], "alpha_n,tau,n_unstable,status,marks");
  for (const k of [1, 5000, rows.length - 1]) {
    const [gain, tau, n] = rows[k].split(",").map(Number);
    assert.equal(
      asked(["point", "--mu-prime=-0.3", `--alpha-n=${gain}`, `--tau=${tau}`]).n_unstable,
      n,
      rows[k],
    );
  }
});

test("the maps that slipmap ships open, one of one axis too", async () => {
  slipmap(["run", join(ROOT, "sweeps/fig4.toml"), "-o", join(folder, "fig4.h5")]);
  const page = await openPage(browser, server.link);
  await page.getByRole("button", { name: /^Maps/ }).click();
  await page.locator("#maps-table", { hasText: "fig4.h5" }).waitFor({ timeout: 10000 });
  await page.getByRole("button", { name: "fig4.h5" }).click();
  await atRest(page);
  assert.match(await page.locator("#chart-title").innerText(), /over γ/);
  assert.deepEqual(page.faults, []);
});
