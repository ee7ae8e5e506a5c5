// Maps from files in a real browser: what is on the screen is what the file holds and the command says.

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { readFileSync, rmSync, writeFileSync } from "node:fs";
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
picture = "n_unstable"
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

/** One axis only. */
const LINE = `fields = ["vc", "outcome"]
[axes]
alpha_v = { from = -1.0, to = -0.1, points = 12 }
[fixed]
tau = 2.0
[friction]
law = "weakening"
mu0 = 0.5
v_s = 0.5
`;

makeMap("counts.h5", COUNTS);
makeMap("fine.h5", FINE);
makeMap("rates.h5", RATES);
makeMap("critical.h5", CRITICAL);
makeMap("line.h5", LINE);
const whole = readFileSync(join(folder, "rates.h5"));
writeFileSync(join(folder, "broken.h5"), whole.subarray(0, 5000));
for (let at = 300; at < 3000; at += 7) whole[at] ^= 0x5a;
writeFileSync(join(folder, "odd.h5"), whole);
const { browser, server } = await opened([folder]);

/** The id by which an address names a map. */
const idOf = (page, name) =>
  page.evaluate(async (wanted) => {
    const { maps } = await (await fetch("api/v1/maps")).json();
    return maps.find((map) => map.name === wanted).id;
  }, name);

/** Opens a page by its address, which may name a map that is not there. */
async function goTo(page, hash) {
  await page.goto("about:blank");
  await page.goto(server.link.replace(/\?.*/, "") + hash);
  await page.waitForFunction(() => window.slipmap);
}

/** The text of a file that a button offers. */
async function taken(page, name) {
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    page.getByRole("button", { name, exact: true }).click(),
  ]);
  return [download.suggestedFilename(), readFileSync(await download.path(), "utf8")];
}

/** Rows of the text of a CSV file, without its comments. */
const rowsOf = (csv) =>
  csv
    .trim()
    .split("\n")
    .filter((line) => !line.startsWith("#"));

/**
 * The answer of a window with another head; `change` may put arrays of one repeated number into it
 * by `run(type, value, length)`.
 */
function altered(body, change) {
  const length = body.readUInt32LE(0);
  const head = JSON.parse(body.subarray(4, 4 + length));
  const parts = [body.subarray(Math.ceil((4 + length) / 8) * 8)];
  const end = () => parts.reduce((sum, part) => sum + part.length, 0);
  const run = (type, value, count) => {
    parts.push(Buffer.alloc((8 - (end() % 8)) % 8));
    const [offset, one] = [end(), Buffer.alloc(16)];
    if (type === "u8") one.writeUInt8(value);
    else one.writeUInt16LE(value);
    one.writeUInt32LE(count, 8);
    parts.push(one);
    return { type, offset, length: count, runs: 1 };
  };
  change(head, run);
  const text = Buffer.from(JSON.stringify(head));
  const begin = Buffer.alloc(Math.ceil((4 + text.length) / 8) * 8, 32);
  begin.writeUInt32LE(text.length);
  text.copy(begin, 4);
  return Buffer.concat([begin, ...parts]);
}

/** Questions for windows of planes, that `answer(route, query, number)` answers. */
async function windows(page, answer) {
  let number = 0;
  await page.route("**/window?*", (route) => {
    const query = Object.fromEntries(new URL(route.request().url()).searchParams);
    return query.h === "1" ? route.continue() : answer(route, query, number++);
  });
}

/** Something that is waited for until it is let go. */
function gate() {
  let open;
  const opened = new Promise((done) => (open = done));
  return { open, opened };
}

/** Remembers what is shown from now on, as `window.planes`. */
const watchPlanes = (page) =>
  page.evaluate(() => {
    const { plane, saved } = window.slipmap;
    window.planes = [];
    const show = plane.show.bind(plane);
    plane.show = (shown) => {
      const { axes, ends, fixed } = shown;
      window.planes.push({
        map: saved.map?.name,
        axes: axes.map(({ name, values }) => [name, Math.min(...values), Math.max(...values)]),
        ends: ends.map(({ from, to }) => [from, to]),
        fixed: Object.fromEntries((fixed ?? []).map(({ name, value }) => [name, value])),
      });
      show(shown);
    };
  });

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
    const { ends, nx, ny, axes, cells, bits, gaps, colours } = plane.plane;
    return all.map((part) => {
      const cell = [Math.floor(part[0] * nx), Math.floor(part[1] * ny)];
      const n = cell[0] * ny + cell[1];
      const point = cell.map((index, i) => ends[i].value((index + 0.5) / [nx, ny][i]));
      // Over what has no value to show there are lines.
      const pixel = gaps[n] ? 0 : colours.pixel(cells[n]);
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
  await page.getByRole("button", { name: "Maps (7)" }).click();
  const rows = await page.locator("#maps-table tbody tr").allInnerTexts();
  const of = (name) => rows.find((row) => row.startsWith(name));
  assert.match(
    of("counts.h5"),
    /complete.*μ′ \(4\) × α_v \(401\) × τ \(301\).*n_unstable.*482,804/s,
  );
  assert.match(of("broken.h5"), /damaged/);
  assert.match(of("odd.h5"), /damaged.*checksum/);
  for (const name of ["broken.h5", "odd.h5"]) {
    assert.ok(await page.getByRole("button", { name }).isDisabled());
  }
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
  await page.waitForFunction(() => window.slipmap.saved.slice.line?.data[0].length === 12);
  const line = await page.evaluate(() =>
    window.slipmap.saved.slice.line.data.map((list) => [...list]),
  );
  assert.ok(
    line[0].every((x, i) => i === 0 || x > line[0][i - 1]),
    "in order",
  );
  assert.ok(line[1].some((x) => x > 0));
  assert.equal(await page.locator("#slice-title").innerText(), "Critical velocity along α_v");
  await page.locator("#field").selectOption("outcome");
  await page.waitForFunction(() =>
    /^Outcome/.test(document.getElementById("slice-title").innerText),
  );
  const words = await page.evaluate(() => {
    const { slice } = window.slipmap.saved;
    const [, values] = slice.line.data;
    return values.map((value, place) => slice.line.series[1].value(slice.line, value, 1, place));
  });
  assert.ok(words.includes("grazing") && words.every((word) => !/\d/.test(word)), `${words}`);
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
  assert.doesNotMatch(address, /cell=/);
  const chosen = () =>
    page.evaluate(() => [window.slipmap.state.map.at, window.slipmap.plane.point]);
  const before = await chosen();
  assert.match(address, /#v=1&map=[0-9a-f]{16}&field=n_unstable&x=alpha_v&y=tau/);
  const picture = () => page.evaluate(() => document.getElementById("chart").toDataURL());
  const seen = await picture();
  await page.goto("about:blank");
  await page.goto(address);
  await page.waitForFunction(() => window.slipmap?.saved.map);
  await atRest(page);
  await page.waitForTimeout(300);
  assert.ok((await picture()) === seen, "the same picture, pixel by pixel");
  assert.deepEqual(await chosen(), before);
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
    await page.waitForFunction(() => window.slipmap.plane.plane?.field.name === "vc");
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
  const told = page.locator("#problem");
  await eventually(async () => {
    // What the server has read already may still be seen.
    for (const field of ["abscissa", "n_unstable"]) {
      await page.locator("#field").selectOption(field, { timeout: 1000 });
      await page.getByRole("button", { name: "Zoom in" }).click();
    }
    assert.match(await told.innerText(), /cannot be read|not a map|changed|damaged/);
  });
  // A view that was read before may stay; of another one nothing is seen.
  const field = page.locator("#field");
  if (await field.isVisible()) await field.selectOption("abscissa", { timeout: 1000 });
  await eventually(async () => assert.equal(await blank(page), true));
  rmSync(gone);
  await eventually(async () => {
    await page.evaluate(() => window.slipmap.saved.open());
    assert.match(await told.innerText(), /no map of this id|No such file/);
  });
  assert.equal(await page.locator("#chart-title").innerText(), "No map");
  await page.getByRole("button", { name: "Live chart" }).click();
  await atRest(page);
  assert.equal(await page.locator("#origin").innerText(), "computed now");
  const faults = page.faults.filter((fault) => !/status of (404|502|503)/.test(fault));
  assert.deepEqual(faults, []);
});

test("a map's sweep file and its cells can be taken along", async () => {
  const page = await withMap("rates.h5");
  assert.deepEqual(await taken(page, "Sweep file"), ["rates.toml", RATES]);
  const [name, csv] = await taken(page, "CSV");
  assert.equal(name, "rates.csv");
  const rows = rowsOf(csv);
  assert.equal(rows[0], "alpha_n,tau,n_unstable,status");
  assert.equal(rows.length, 1 + 120 * 100, "each cell once");
  assert.match(csv, /^# mu_prime = -0.3$/m);
  assert.match(csv, /^# along alpha_n 120 of 120 values, all in view$/m);
  for (const k of [1, 5000, rows.length - 1]) {
    const [gain, tau, n] = rows[k].split(",").map(Number);
    assert.equal(
      asked(["point", "--mu-prime=-0.3", `--alpha-n=${gain}`, `--tau=${tau}`]).n_unstable,
      n,
      rows[k],
    );
  }
  await openMap(page, "critical.h5");
  await page.locator("#field").selectOption("outcome");
  await atRest(page);
  const kinds = rowsOf((await taken(page, "CSV"))[1]);
  assert.equal(kinds.length, 1 + 12 * 10);
  assert.equal(new Set(kinds).size, kinds.length);
  assert.ok(
    kinds.slice(1).every((row) => /^-[\d.]+,[\d.]+,[a-z-]+,\d+$/.test(row)),
    kinds[1],
  );
  await openMap(page, "fine.h5");
  const fine = (await taken(page, "CSV"))[1];
  assert.match(fine, /^# along tau \d+ of 2500 values, those that pixels show/m);
  assert.deepEqual(page.faults, []);
});

/** Whether nothing is drawn on the chart, and nothing said of it. */
const blank = (page) =>
  page.evaluate(() => {
    const chart = document.getElementById("chart");
    const { data } = chart.getContext("2d").getImageData(0, 0, chart.width, chart.height);
    const words = ["readout", "hover", "legend"].map((id) => document.getElementById(id).innerText);
    return data.every((part) => part === 0) && words.join("") === "";
  });

test("an answer that is not wanted any more neither stays nor is taken for another one", async () => {
  const page = await withMap("counts.h5");
  await watchPlanes(page);
  // The first answer comes when the slider has moved on, and is not complete; the second is slow.
  const first = gate();
  const asked = [];
  await windows(page, async (route, query, number) => {
    asked.push(query.at);
    if (number > 1) return route.continue();
    const response = await route.fetch();
    if (number === 1) await new Promise((done) => setTimeout(done, 200));
    else await first.opened;
    const body = altered(await response.body(), (head) => {
      if (number === 0) Object.assign(head, { complete: false, progress: 0.5 });
    });
    return route.fulfill({ response, body }).catch(() => {});
  });
  await page.locator("#at-mu_prime").fill("0");
  await eventually(() => assert.equal(asked.length, 1));
  await page.locator("#at-mu_prime").fill("3");
  first.open();
  await page.waitForFunction(() => window.planes.length > 1);
  await page.waitForTimeout(150);
  await atRest(page);
  assert.deepEqual(asked, ["mu_prime:0", "mu_prime:3"]);
  const planes = await page.evaluate(() => window.planes);
  assert.equal(planes.at(-1).fixed.mu_prime, -0.1);
  await page.unroute("**/window?*");

  // Other axes, and then another map, while answers are on their way.
  const [turned, away] = [gate(), gate()];
  await windows(page, async (route, query, number) => {
    if (number > 2) return route.continue();
    const response = await route.fetch();
    if (number === 0) await turned.opened;
    if (number === 2) await away.opened;
    return route.fulfill({ response }).catch(() => {});
  });
  await page.evaluate(() => (window.planes = []));
  await page.locator("#at-mu_prime").fill("1");
  await page.locator("#map-x").selectOption("tau");
  turned.open();
  await atRest(page);
  await page.locator("#at-mu_prime").fill("2");
  await openMap(page, "rates.h5");
  away.open();
  await page.waitForTimeout(100);
  await atRest(page);
  const ends = { alpha_v: [-1.6, 0.4], tau: [0, 12], alpha_n: [-3, 1] };
  for (const { map, axes, ends: seen } of await page.evaluate(() => window.planes)) {
    const names = axes.map(([name]) => name);
    assert.deepEqual(names, map === "rates.h5" ? ["alpha_n", "tau"] : ["tau", "alpha_v"]);
    const whole = map === "rates.h5" ? { ...ends, tau: [0.01, 10] } : ends;
    axes.forEach(([name, low, high], i) => {
      assert.deepEqual(
        [low, high].map((x) => Number(x.toFixed(6))),
        whole[name],
      );
      assert.deepEqual(seen[i], whole[name]);
    });
  }
  assert.equal(await page.locator("#slice-title").innerText(), "Number of unstable roots along τ");
  assert.deepEqual(page.faults, []);
});

test("where there is no cell, there is no value", async () => {
  const page = await withMap("rates.h5");
  await page.locator("#table-part").evaluate((part) => (part.open = true));
  for (const [bits, words] of [
    [2, "not read yet"],
    [4, "not computed"],
  ]) {
    await windows(page, async (route) => {
      const response = await route.fetch();
      const body = altered(await response.body(), (head, run) => {
        const { length } = head.bits;
        head.bits = run("u8", bits, length);
        head.values = run("u16", 65535, length);
        head.status = run("u8", 255, length);
        const fill = { gap: 9, name: "not-computed", text: words, ground: "#ffffff", lines: [] };
        head.gaps = run("u8", bits === 2 ? 0 : fill.gap, length);
        head.shown = {
          ...head.shown,
          entries: bits === 2 ? [] : [{ text: words, colour: null, gap: fill.gap }],
          fills: bits === 2 ? [] : [fill],
        };
        head.complete = bits !== 2;
      });
      // The next question may come while this is no longer listened to.
      return route.fulfill({ response, body }).catch(() => {});
    });
    await page.getByRole("button", { name: bits === 2 ? "Zoom in" : "Zoom out" }).click();
    await page.locator("#legend", { hasText: words }).waitFor();
    // The button may lie below the chart.
    await page.evaluate(() => window.scrollTo(0, 0));
    const at = await placeOf(page, [-1.2, 5]);
    await page.mouse.move(at.x, at.y);
    await page.mouse.move(at.x + 1, at.y);
    await eventually(async () => {
      const hover = await page.locator("#hover").innerText();
      assert.match(hover, new RegExp(`^α_N = −1\\.\\d+, τ = [45]\\.\\d+: ${words}$`));
    });
    await eventually(async () => {
      const cells = await page.locator("#table td").allInnerTexts();
      assert.ok(cells.length > 20 && cells.every((text) => text === words), cells[0]);
    });
    const rows = rowsOf((await taken(page, "CSV"))[1]);
    assert.equal(rows[0], "alpha_n,tau,n_unstable,status,lacking");
    assert.ok(
      rows.slice(1).every((row) => row.endsWith(`,,,${words}`)),
      rows[1],
    );
    await page.unroute("**/window?*");
  }
  assert.deepEqual(page.faults, []);
});

test("beyond the ends of its axes a map has no cells", async () => {
  const page = await withMap("rates.h5");
  await page.getByRole("button", { name: "Zoom out" }).click();
  await atRest(page);
  const { ends, view } = await page.evaluate(() => {
    const of = (scales) => scales.map(({ from, to }) => [from, to]);
    return { ends: of(window.slipmap.plane.plane.ends), view: of(window.slipmap.plane.view) };
  });
  assert.deepEqual(ends, [
    [-3, 1],
    [0.01, 10],
  ]);
  assert.ok(view[0][0] < -3.5 && view[1][1] > 10.5);
  const at = await placeOf(page, [-3.4, 5]);
  await page.mouse.move(at.x, at.y);
  assert.equal(await page.locator("#hover").innerText(), "");
});

test("a map that cannot be opened leaves nothing of what was seen before", async () => {
  const page = await openPage(browser, server.link);
  await page.evaluate(() => (location.hash = "#v=1&map=0000000000000000"));
  await page.locator("#problem", { hasText: "no map" }).waitFor();
  assert.equal(await blank(page), true);
  assert.equal(await page.locator("#chart-title").innerText(), "No map");
  assert.ok(await page.locator("#origin").isHidden());
  assert.ok(await page.locator("#map").isHidden());
  const box = await page.locator("#chart").boundingBox();
  await page.mouse.move(box.x + 300, box.y + 200);
  await page.mouse.down();
  await page.mouse.move(box.x + 400, box.y + 250, { steps: 3 });
  await page.mouse.up();
  await page.mouse.dblclick(box.x + 300, box.y + 200);
  for (const key of ["+", "-", "0", "ArrowLeft", "Enter"]) {
    await page.locator("#chart").press(key);
  }
  await page.getByRole("button", { name: "All", exact: true }).click();
  assert.equal(await blank(page), true);
  await openMap(page, "line.h5");
  assert.equal(await page.locator("#origin").innerText(), "from the file");
  assert.deepEqual(
    page.faults.filter((fault) => !/status of 404/.test(fault)),
    [],
  );
});

test("a map of one axis is a strip with a line, and says nothing of a second one", async () => {
  const page = await withMap("line.h5");
  await page.locator("#field").selectOption("outcome");
  await atRest(page);
  assert.equal(await page.locator("#chart-title").innerText(), "Outcome over α_v");
  assert.ok(await page.locator("#map-y").isHidden());
  assert.ok(await page.locator("#y-log").isHidden());
  assert.match(await page.locator("#readout").innerText(), /^α_v = −0\.5090909: [a-z-]+$/);
  const svg = (await taken(page, "SVG"))[1];
  assert.ok(!/null|undefined|>0\.2</.test(svg), "no ticks upwards");
  const rows = rowsOf((await taken(page, "CSV"))[1]);
  assert.equal(rows[0], "alpha_v,outcome,status");
  assert.equal(rows.length, 13);
  await page.locator("#chart").focus();
  const index = () => page.evaluate(() => window.slipmap.state.map.at.alpha_v);
  const begun = await index();
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowUp");
  assert.equal(await index(), begun + 1);
  await page.keyboard.press("+");
  await atRest(page);
  const at = await placeOf(page, [-0.6, 0.3]);
  await page.mouse.move(at.x, at.y);
  assert.match(await page.locator("#hover").innerText(), /^α_v = −0\.\d+: [a-z-]+$/);
  await page.mouse.click(at.x, at.y);
  assert.equal(await index(), 5);
  await page.locator("#point-where", { hasText: /^α_v = −0\.5909/ }).waitFor();
  await page.waitForFunction(() => window.slipmap.saved.slice.line?.data[0].length === 12);
  await picture(page, "map-one-axis");
  assert.deepEqual(page.faults, []);
});

test("a map that grows leaves the slider, the focus and the critical velocity alone", async () => {
  const page = await withMap("counts.h5");
  /** As if a cell more were there in each answer. */
  const growing = async () => {
    let done = 1000;
    const grown = (map) => ({ ...map, state: "running", cells_done: done, version: done });
    await page.route(/\/api\/v1\/maps(\/[0-9a-f]{16})?$/, async (route) => {
      const response = await route.fetch();
      const told = await response.json();
      if (told.maps) done += 1;
      const json = told.maps ? { ...told, maps: told.maps.map(grown) } : grown(told);
      return route.fulfill({ response, json });
    });
  };
  const grow = async () => {
    await page.evaluate(() => window.slipmap.saved.list.look());
    await page.waitForFunction(() => {
      const { saved } = window.slipmap;
      return saved.seen === `${saved.map.cells_done} running`;
    });
    await atRest(page);
  };
  await growing();
  await page.locator("#at-mu_prime").focus();
  await page.evaluate(() => (window.slider = document.activeElement));
  await grow();
  assert.match(await page.locator("#map-told").innerText(), /running/);
  assert.ok(await page.evaluate(() => window.slider === document.activeElement));
  await page.keyboard.press("ArrowRight");
  assert.equal(await page.evaluate(() => window.slipmap.state.map.at.mu_prime), 3);
  await openMap(page, "critical.h5");
  await page.waitForFunction(() => /ends by/.test(document.getElementById("vc").innerText));
  await page.evaluate(() => {
    const list = document.getElementById("vc");
    window.texts = [list.innerText];
    const watch = new MutationObserver(() => window.texts.push(list.innerText));
    watch.observe(list, { childList: true, subtree: true });
  });
  await grow();
  await page.waitForTimeout(100);
  const texts = new Set(await page.evaluate(() => window.texts));
  assert.equal(texts.size, 1, [...texts].join(" / "));
  assert.deepEqual(page.faults, []);
});

test("ticks of a narrow view can be told apart, and are not cut off", async () => {
  const page = await withMap("rates.h5");
  const id = await idOf(page, "rates.h5");
  for (const [ranges, titles] of [
    ["xr=-0.33000001,-0.32999999&yr=4.1499999,4.1500001", ["α_N + 0.33", "τ − 4.15"]],
    ["xr=-0.331,-0.329&yr=4.1,4.2", ["α_N", "τ"]],
  ]) {
    await goTo(page, `#v=1&map=${id}&field=abscissa&${ranges}`);
    await atRest(page);
    const { labels, over } = await page.evaluate(async () => {
      const { plane } = window.slipmap;
      const { SvgPen } = await import("./pen.js");
      const pen = new SvgPen(
        [plane.canvas.clientWidth, plane.canvas.clientHeight],
        getComputedStyle(plane.canvas),
      );
      plane.drawWith(pen);
      const svg = new DOMParser().parseFromString(pen.file(), "image/svg+xml").documentElement;
      document.body.append(svg);
      const [box, list] = [svg.getBoundingClientRect(), [...svg.querySelectorAll("text")]];
      const found = {
        labels: list.map((text) => text.textContent),
        over: list.filter((text) => {
          const { left, right } = text.getBoundingClientRect();
          return left < box.left - 1 || right > box.right + 1;
        }).length,
      };
      svg.remove();
      return found;
    });
    assert.equal(over, 0, `${labels}`);
    for (const title of titles) assert.ok(labels.includes(title), `${labels}`);
    const up = labels.indexOf(titles[0]);
    for (const ticks of [labels.slice(0, up), labels.slice(up + 1, -1)]) {
      assert.ok(ticks.length > 2 && new Set(ticks).size === ticks.length, `${ticks}`);
    }
  }
  await picture(page, "map-narrow");
});

test("what an axis cannot be is told", async () => {
  const page = await withMap("counts.h5");
  const id = await idOf(page, "counts.h5");
  await goTo(page, `#v=1&map=${id}&x=alpha_v&y=mu_prime&xr=1,1&xlog=1`);
  await atRest(page);
  const told = await page.locator("#speed").innerText();
  assert.match(told, /no logarithm of 0: α_v; xr=1,1 is no part of the axis/);
  const box = page.getByRole("checkbox", { name: "logarithmic across" });
  assert.ok((await box.isDisabled()) && !(await box.isChecked()));
  assert.match(await page.locator("#x-log-why").innerText(), /axis with 0/);
  assert.ok(await page.locator("#y-log").isEnabled());
  const view = () => page.evaluate(() => window.slipmap.plane.view[0]);
  assert.equal((await view()).from, -1.6);
  await page.waitForFunction(() => !/xlog|xr/.test(location.hash));
  // A logarithm goes along with its axis, and not to one that has none.
  await page.locator("#y-log").check();
  await page.locator("#map-x").selectOption("mu_prime");
  await atRest(page);
  assert.ok(await page.locator("#x-log").isChecked());
  await page.locator("#map-x").selectOption("tau");
  await atRest(page);
  assert.ok(!(await page.locator("#x-log").isChecked()) && !(await view()).log);
  assert.deepEqual(page.faults, []);
});

test("the list tells when it is open, and how long ago", async () => {
  const page = await openPage(browser, server.link);
  let seconds = 5;
  await page.route("**/api/v1/maps", async (route) => {
    const response = await route.fetch();
    const told = await response.json();
    for (const map of told.maps) map.age_seconds = seconds;
    return route.fulfill({ response, json: told });
  });
  const list = page.getByRole("button", { name: /^Maps/ });
  await list.click();
  assert.equal(await list.getAttribute("aria-expanded"), "true");
  for (seconds of [5, 8]) {
    await page.evaluate(() => window.slipmap.saved.list.look());
    await page.locator("tr", { hasText: "rates.h5" }).getByText(`${seconds} seconds ago`).waitFor();
  }
  await page.getByRole("button", { name: "rates.h5" }).click();
  assert.equal(await list.getAttribute("aria-expanded"), "false");
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
