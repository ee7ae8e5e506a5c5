// Maps on the page say the same as pictures of them, the command and the file: colours, classes and
// words. The list of maps, the first view of one, and files of what is seen.

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import {
  PROGRAM,
  atRest,
  eventually,
  newFolder,
  openPage,
  opened,
  picture,
  slipmap,
  violations,
} from "./support.mjs";

const folder = newFolder();
/** Files that are looked at once. */
const scratch = newFolder();
let number = 0;
const newFile = (ending) => join(scratch, `${(number += 1)}.${ending}`);

/** Makes a map in the folder from the text of a sweep. */
function makeMap(name, text) {
  const sweep = newFile("toml");
  writeFileSync(sweep, text);
  slipmap(["run", sweep, "-o", join(folder, name)]);
}

const GAIN = `fields = ["n_unstable", "reason", "delay_margin", "abscissa", "abscissa_2",
  "relaxation_time", "frequency", "phase_margin", "latency_margin", "d_abscissa_d_tau"]
title = "Of the roots"
[axes]
alpha_v = { from = -1.6, to = 0.4, points = 24 }
tau = { from = 0.0, to = 12.0, points = 18 }
[fixed]
mu_prime = -0.3
`;
/** Without control, sliding is marginal here. */
const MARGINAL = `fields = ["n_unstable", "delay_margin", "abscissa"]
picture = "delay_margin"
title = "A slope of 0"
[axes]
alpha_v = { from = -1.6, to = 0.4, points = 21 }
tau = { from = 0.0, to = 12.0, points = 13 }
[fixed]
mu_prime = 0.0
`;
const CRITICAL = `fields = ["vc", "windows", "outcome", "method", "v_liftoff", "slip_time", "regime"]
title = "Critical velocities"
[axes]
alpha_n = { from = -1.0, to = 0.4, points = 20 }
tau = { from = 0.1, to = 3.0, points = 10 }
[fixed]
v0 = 0.5
[friction]
law = "coulomb"
mu0 = 0.4
mu_s = 0.6
`;
const MOTIONS = `fields = ["outcome", "settle_time", "last_release", "n_min"]
title = "Motions"
[axes]
alpha_v = { from = -1.0, to = 0.4, points = 20 }
tau = { from = 0.1, to = 6.1, points = 11 }
[fixed]
v0 = 0.35
[friction]
law = "weakening"
mu0 = 0.5
v_s = 0.5
`;
const LIMIT = `title = "A short delay"
protocol = "limit"
[axes]
gamma = { from = 0.005, to = 1.1, points = 23 }
mu_ratio = { from = 0.1, to = 1.0, points = 10 }
`;

makeMap("gain.h5", GAIN);
makeMap("marginal.h5", MARGINAL);
makeMap("critical.h5", CRITICAL);
makeMap("motions.h5", MOTIONS);
makeMap("limit.h5", LIMIT);
const NAMES = ["critical.h5", "gain.h5", "limit.h5", "marginal.h5", "motions.h5"];
const { browser, server } = await opened([folder]);

async function openMap(page, name) {
  const list = page.getByRole("button", { name: /^Maps \(/ });
  if ((await list.getAttribute("aria-expanded")) !== "true") await list.click();
  await page.getByRole("button", { name, exact: true }).click();
  await page.waitForFunction((wanted) => window.slipmap.saved.map?.name === wanted, name);
  await atRest(page);
}

/** What the page shows of every cell: its most frequent colours, its words, and the legend. */
const seenOf = (page) =>
  page.evaluate(async () => {
    const { wordsOf, gapOf } = await import("./cells.js");
    const { plane: view } = window.slipmap;
    const { plane, canvas } = view;
    // The cursor covers cells.
    view.point = null;
    view.draw();
    const [area, scale] = [view.area(), window.devicePixelRatio];
    const context = canvas.getContext("2d", { willReadFrequently: true });
    const { data, width } = context.getImageData(0, 0, canvas.width, canvas.height);
    const hex = (at) => `#${[0, 1, 2].map((k) => data[at + k].toString(16).padStart(2, "0")).join("")}`;
    // The pixels of each cell along an axis.
    const stretches = plane.axes.map(({ index }) => {
      const found = new Map();
      index.forEach((cell, pixel) => found.set(cell, [...(found.get(cell) ?? []), pixel]));
      return found;
    });
    const cells = [];
    for (const [i, across] of stretches[0]) {
      for (const [j, up] of stretches[1]) {
        const count = new Map();
        const middle = (list) => list[Math.floor(list.length / 2)];
        const [px, py] = [middle(across), middle(up)];
        for (let dx = -4; dx <= 4; dx++) {
          for (let dy = -4; dy <= 4; dy++) {
            const x = Math.round((area.x + ((px + dx + 0.5) / plane.nx) * area.w) * scale - 0.5);
            const y = Math.round((area.y + (1 - (py + dy + 0.5) / plane.ny) * area.h) * scale - 0.5);
            const colour = hex(4 * (y * width + x));
            count.set(colour, (count.get(colour) ?? 0) + 1);
          }
        }
        const n = px * plane.ny + py;
        const [colour] = [...count].sort((p, q) => q[1] - p[1])[0];
        const gap = gapOf(plane, n)?.name ?? null;
        cells.push({ i, j, colour, words: wordsOf(plane, n), gap, status: plane.status[n] });
      }
    }
    const legend = [...document.querySelectorAll("#legend > li")].map((item) => item.textContent);
    const colourOf = ({ colour, gap }) =>
      colour ?? plane.shown.fills.find((fill) => fill.gap === gap).ground;
    const entries = plane.shown.entries.map((entry) => [entry.text, colourOf(entry)]);
    const points = plane.axes.map((axis) => axis.points);
    const readout = document.getElementById("readout").textContent;
    return { cells, legend, entries, points, readout };
  });

/** The most frequent colours of cells in a picture that was drawn, and its words. */
async function drawn(page, map, field, points) {
  const files = ["svg", "png"].map(newFile);
  for (const file of files) slipmap(["plot", join(folder, map), "-o", file, "--field", field]);
  const svg = readFileSync(files[0], "utf8");
  const text = [...svg.matchAll(/<text[^>]*>\s*([^<]*?)\s*<\/text>/g)].map(([, words]) => words);
  const rects = [...svg.matchAll(/<rect x="(\d+)" y="(\d+)" width="(\d+)" height="(\d+)"[^>]*#222222/g)]
    .map(([, ...numbers]) => numbers.map((n) => Number(n) / 10));
  // The frame is made of four thin ones.
  const across = rects.filter(([, , , h]) => h < 2.5).sort((p, q) => q[2] - p[2])[0];
  const up = rects.filter(([, , w]) => w < 2.5).sort((p, q) => q[3] - p[3])[0];
  const frame = [across[0], up[1], across[2], up[3]];
  const urls = ["svg+xml", "png"].map(
    (kind, i) => `data:image/${kind};base64,${readFileSync(files[i]).toString("base64")}`,
  );
  const colours = await page.evaluate(
    async ([sources, [left, top, width, height], [nx, ny]]) => {
      const all = [];
      for (const source of sources) {
        const image = new Image();
        image.src = source;
        await image.decode();
        const canvas = document.createElement("canvas");
        [canvas.width, canvas.height] = [1600, 1100];
        const context = canvas.getContext("2d", { willReadFrequently: true });
        context.drawImage(image, 0, 0, 1600, 1100);
        const { data } = context.getImageData(0, 0, 1600, 1100);
        const hex = (at) =>
          `#${[0, 1, 2].map((k) => data[at + k].toString(16).padStart(2, "0")).join("")}`;
        const found = {};
        for (let i = 0; i < nx; i++) {
          for (let j = 0; j < ny; j++) {
            const count = new Map();
            // The axes end at the first and the last value, in the middle of a cell.
            const x = left + Math.min(Math.max((i * width) / (nx - 1), 8), width - 8);
            const y = top + Math.min(Math.max(height - (j * height) / (ny - 1), 8), height - 8);
            const at = [x, y].map(Math.round);
            for (let dx = -5; dx <= 5; dx++) {
              for (let dy = -5; dy <= 5; dy++) {
                const colour = hex(4 * ((at[1] + dy) * 1600 + at[0] + dx));
                count.set(colour, (count.get(colour) ?? 0) + 1);
              }
            }
            found[`${i} ${j}`] = [...count].sort((p, q) => q[1] - p[1])[0][0];
          }
        }
        all.push(found);
      }
      return all;
    },
    [urls, frame, points],
  );
  return { svg: colours[0], png: colours[1], text };
}

/** Words without what tells subscripts apart. */
const plain = (words) => words.replace(/[\s_]/g, "");

/** What the file has in each cell of a field, by the command. */
function fileOf(map, field, axes) {
  const text = slipmap(["export", join(folder, map), "--field", field]);
  const [head, ...rows] = text.trim().split("\n").map((line) => line.split(","));
  const column = (name) => head.indexOf(name);
  const distinct = axes.map((name) => [
    ...new Set(rows.map((row) => row[column(name)])),
  ]);
  const found = {};
  for (const row of rows) {
    const at = axes.map((name, k) => distinct[k].indexOf(row[column(name)]));
    found[at.join(" ")] = { value: row[column(field)], status: row[column("status")], row };
  }
  return found;
}

const MINUS = "−";
const numberOf = (words) => {
  const text = words.replaceAll(MINUS, "-").split(/[:,]/)[0].trim();
  return text === "∞" ? Infinity : text === "-∞" ? -Infinity : Number(text);
};

test("every cell has the colour and the words of pictures, of the command and of the file", async () => {
  const page = await openPage(browser, server.link);
  const known = await page.evaluate(() => window.slipmap.catalogue.fields);
  const seen = { spread: new Set(), storage: new Set(), gaps: new Set(), words: new Set() };
  const wrong = [];
  for (const map of NAMES) {
    await openMap(page, map);
    const fields = await page.evaluate(() => window.slipmap.saved.map.fields);
    for (const field of fields) {
      await page.locator("#field").selectOption(field.name);
      await atRest(page);
      const { cells, legend, entries, points } = await seenOf(page);
      const axes = await page.evaluate(() => window.slipmap.plane.plane.axes.map(({ name }) => name));
      const { svg, png, text } = await drawn(page, map, field.name, points);
      const file = fileOf(map, field.name, axes);
      assert.ok(cells.length >= 200, `${map} ${field.name}: ${cells.length} cells`);
      const where = `${map} ${field.name}`;
      const all = plain(text.join(""));
      for (const [words] of entries) {
        assert.ok(legend.includes(words), `${where}: ${words} is in the legend`);
        assert.ok(all.includes(plain(words)), `${where}: ${words} is in the picture`);
        seen.words.add(words);
      }
      for (const { i, j, colour, words, gap } of cells) {
        const at = `${i} ${j}`;
        const { value, status } = file[at];
        const tell = `${where} ${file[at].row}: ${words} ${colour}, ${svg[at]} ${png[at]}`;
        if (colour !== svg[at] || colour !== png[at]) wrong.push(tell);
        const entry = entries.find(([, own]) => own === colour);
        const marginal = Number(status) & 2;
        if (marginal && (/^stable/.test(words) || /stable/.test(entry?.[0] ?? "")))
          wrong.push(`marginal and stable: ${tell}`);
        if (gap) {
          seen.gaps.add(gap);
          if (entry?.[0] !== words) wrong.push(`not ${entry}: ${tell}`);
          if (["no-value", "lifts-off", "persists"].includes(gap) && value !== "" && value !== "nan")
            wrong.push(`a value: ${tell}`);
          continue;
        }
        if (field.kinds) {
          if (words !== value) wrong.push(`not ${value}: ${tell}`);
        } else if (field.name === "n_unstable") {
          const n = Number(value);
          const class_ = n === 0 ? "0, stable" : n > 8 ? "8 or more" : value;
          if (entry?.[0] !== class_) wrong.push(`not ${class_}: ${tell}`);
          if (words !== (n === 0 ? "stable" : `${n} unstable root${n === 1 ? "" : "s"}`))
            wrong.push(tell);
        } else if (!(Math.abs(numberOf(words) - Number(value.replace("inf", "Infinity"))) <= 1e-5 * Math.abs(numberOf(words)))) {
          if (numberOf(words) !== Number(value.replace("inf", "Infinity")))
            wrong.push(`not ${value}: ${tell}`);
        }
      }
      const about = known.find(({ name }) => name === field.name);
      seen.spread.add(about.spread);
      seen.storage.add(about.storage);
    }
  }
  assert.deepEqual(wrong.slice(0, 20), [], `${wrong.length} cells`);
  const spreads = new Set(known.map(({ spread }) => spread));
  assert.deepEqual([...seen.spread].sort(), [...spreads].sort());
  assert.deepEqual([...seen.storage].sort(), ["count", "few", "kind", "real"]);
  for (const gap of ["marginal", "no-value"]) assert.ok(seen.gaps.has(gap), [...seen.gaps].join());
  for (const words of ["0, stable", "marginal", "∞, unstable", "−∞"])
    assert.ok(seen.words.has(words), `${words}: ${[...seen.words].join("; ")}`);
  assert.deepEqual(page.faults, []);
});

test("the command agrees about points of a map", async () => {
  const page = await openPage(browser, server.link);
  await openMap(page, "marginal.h5");
  await page.locator("#field").selectOption("n_unstable");
  await atRest(page);
  const { cells } = await seenOf(page);
  const file = fileOf("marginal.h5", "n_unstable", ["alpha_v", "tau"]);
  let marginal = 0;
  for (const { i, j, words } of cells.filter((_, n) => n % 4 === 0)) {
    const [alpha, tau] = file[`${i} ${j}`].row;
    const flags = ["--mu-prime=0", `--alpha-v=${alpha}`, `--tau=${tau}`];
    const told = slipmap(["point", ...flags]);
    const word = /sliding is +(\w+)/.exec(told)?.[1] ?? /(marginal|unstable|stable)/.exec(told)[1];
    marginal += Number(word === "marginal");
    assert.equal(words.includes("unstable") ? "unstable" : words, word, `${alpha} ${tau}: ${told}`);
  }
  assert.ok(marginal > 3, `${marginal} points are marginal`);
});

test("a map opens with the field and the axes of its picture", async () => {
  const page = await openPage(browser, server.link);
  for (const [map, field, axes] of [
    // As the sweep says it.
    ["marginal.h5", "delay_margin", ["alpha_v", "tau"]],
    ["gain.h5", "abscissa", ["alpha_v", "tau"]],
    ["critical.h5", "regime", ["alpha_n", "tau"]],
    ["motions.h5", "outcome", ["alpha_v", "tau"]],
  ]) {
    await openMap(page, map);
    const found = await page.evaluate(() => {
      const { field: shown, axes: along } = window.slipmap.plane.plane;
      return [shown.name, along.map(({ name }) => name)];
    });
    assert.deepEqual(found, [field, axes], map);
    assert.equal(await page.locator("#field").inputValue(), field);
  }
});

test("files of what is seen carry title, parameters and legend, and no cursor", async () => {
  const page = await openPage(browser, server.link);
  await openMap(page, "marginal.h5");
  const taken = async (name) => {
    const [download] = await Promise.all([
      page.waitForEvent("download"),
      page.getByRole("button", { name, exact: true }).click(),
    ]);
    return readFileSync(await download.path());
  };
  const mark = await page.evaluate(() =>
    getComputedStyle(document.getElementById("chart")).getPropertyValue("--mark").trim(),
  );
  const check = async (name, words) => {
    const svg = (await taken("SVG")).toString();
    const text = [...svg.matchAll(/<text[^>]*>([^<]*)<\/text>/g)].map(([, found]) => found);
    for (const word of words) assert.ok(text.some((line) => line.includes(word)), `${word}: ${text}`);
    const legend = await page.locator("#legend > li").allInnerTexts();
    for (const entry of legend.slice(2))
      assert.ok(text.includes(entry.trim()), `${entry}: ${text}`);
    assert.ok(!svg.includes(mark), `the mark ${mark} is not in it`);
    const png = await taken("PNG");
    const [red, width] = await page.evaluate(
      async ([source, colour]) => {
        const image = new Image();
        image.src = source;
        await image.decode();
        const canvas = document.createElement("canvas");
        [canvas.width, canvas.height] = [image.width, image.height];
        const context = canvas.getContext("2d");
        context.fillStyle = colour;
        context.fillRect(0, 0, 1, 1);
        const own = context.getImageData(0, 0, 1, 1).data;
        context.drawImage(image, 0, 0);
        const { data } = context.getImageData(0, 0, image.width, image.height);
        let count = 0;
        for (let n = 0; n < data.length; n += 4) {
          count += Number([0, 1, 2].every((k) => data[n + k] === own[k]));
        }
        return [count, image.width];
      },
      [`data:image/png;base64,${png.toString("base64")}`, mark],
    );
    assert.equal(red, 0);
    const own = await page.evaluate(() => window.slipmap.plane.canvas.width);
    assert.ok(width > own + 80, `${width} and ${own}`);
    if (process.env.SLIPMAP_SCREENSHOTS) {
      writeFileSync(join(process.env.SLIPMAP_SCREENSHOTS, `file_${name}.png`), png);
      writeFileSync(join(process.env.SLIPMAP_SCREENSHOTS, `file_${name}.svg`), svg);
    }
  };
  await check("map", ["A slope of 0", "Delay margin over α_v and τ", "μ′ = 0", "marginal"]);
  await page.locator("#field").selectOption("n_unstable");
  await atRest(page);
  await check("counts", ["unstable roots", "0, stable", "marginal"]);
  await page.getByRole("button", { name: "Live chart" }).click();
  await atRest(page);
  await check("live", ["Number of unstable roots over α_v and τ", "μ′ = −0.3", "0, stable"]);
  assert.deepEqual(page.faults, []);
});

test("the list shows pictures, sizes and titles, and is searched", async () => {
  const page = await openPage(browser, server.link);
  await page.getByRole("button", { name: /^Maps \(/ }).click();
  const rows = page.locator("#maps-table tbody tr:visible");
  assert.equal(await rows.count(), NAMES.length);
  for (const part of ["A slope of 0", "n_unstable, delay_margin, abscissa", "273 cells", "kB"]) {
    assert.ok((await page.locator("#maps-table").innerText()).includes(part), part);
  }
  // Every picture in sight is made, in its own colours.
  const colours = () =>
    page.evaluate(() =>
      [...document.querySelectorAll("#maps-table canvas")].map((canvas) => {
        const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
        return new Set(new Uint32Array(data.buffer)).size;
      }),
    );
  await eventually(async () => {
    const found = await colours();
    assert.ok(found.every((count) => count > 1), found.join());
  });
  await picture(page, "maps_list");
  assert.deepEqual(await violations(page), []);
  for (const [words, found] of [
    ["slope", ["marginal.h5"]],
    ["MOTION", ["motions.h5"]],
    ["vc_over", ["limit.h5"]],
    ["delay_margin tau", ["gain.h5", "marginal.h5"]],
    ["nothing of this", []],
    ["", NAMES],
  ]) {
    await page.locator("#maps-search").fill(words);
    const names = await page.locator("#maps-table tbody tr:visible button").allInnerTexts();
    assert.deepEqual(names.sort(), found, words);
  }
  await page.locator("#maps-search").fill("slope");
  // What is searched stays while the list is looked at again.
  await page.evaluate(() => window.slipmap.saved.list.look());
  assert.equal(await rows.count(), 1);
  assert.match(await page.locator("#maps").innerText(), /1 of 5 maps/);
});

test("a map that is computed tells how far it is and how long it takes", async () => {
  const sweep = newFile("toml");
  writeFileSync(
    sweep,
    CRITICAL.replace("Critical velocities", "A long one").replace("points = 20", "points = 4000"),
  );
  const path = join(folder, "long.h5");
  const run = spawn(PROGRAM, ["run", sweep, "-o", path, "--threads", "1"], { stdio: "ignore" });
  try {
    const page = await openPage(browser, server.link);
    await page.getByRole("button", { name: /^Maps \(/ }).click();
    const row = page.locator("#maps-table tbody tr", { hasText: "long.h5" });
    await row.locator("progress").waitFor({ timeout: 60000 });
    await row.filter({ hasText: /running, \d+ %, .* left/ }).waitFor({ timeout: 90000 });
    const { value, max } = await row.locator("progress").evaluate((bar) => ({ value: bar.value, max: bar.max }));
    assert.ok(value > 0 && value < max, `${value} of ${max}`);
    // The list changes again and again; pictures are made nevertheless.
    await eventually(async () => {
      const made = await page.evaluate(() =>
        [...document.querySelectorAll("#maps-table canvas")].map((canvas) => {
          const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
          return new Set(new Uint32Array(data.buffer)).size > 1;
        }),
      );
      assert.ok(made.every(Boolean), made.join());
    });
    await picture(page, "maps_running");
  } finally {
    const ended = new Promise((done) => run.once("exit", done));
    run.kill("SIGTERM");
    await ended;
  }
});
