// Models beside the block, and traces, in a real browser: what is on the screen is what slipmap says.

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import {
  ROOT,
  eventually,
  newFolder,
  openPage,
  opened,
  picture,
  settled,
  show,
  slipmap,
  violations,
} from "./support.mjs";

const folder = newFolder();
const asked = (args) => JSON.parse(slipmap([...args, "--json"]));
const words = (page, id) => page.locator(`#${id}`).innerText();

const OWN = `title = "Mine"
B = "s^2 + c*s + 1"
A = "k"
[parameters]
c = { default = 0.4, minimum = 0, long_name = "damping" }
k = { long_name = "gain" }
`;
const SHIPPED = `system = "turning"
fields = ["n_unstable", "delay_margin"]
[axes]
width = { from = 0.0, to = 0.6, points = 13 }
tau = { from = 1.0, to = 16.0, points = 31 }
[fixed]
zeta = 0.04
`;
const CASE = readFileSync(join(ROOT, "sweeps/fig3a.toml"), "utf8");

/** Makes a file in the folder by a command about a text. */
function make(name, command, text) {
  const sources = newFolder();
  writeFileSync(join(sources, "own.toml"), OWN);
  writeFileSync(join(sources, "text.toml"), text);
  slipmap([command, join(sources, "text.toml"), "-o", join(folder, name)]);
}

make("lobes.h5", "run", SHIPPED);
make("own.h5", "run", 'system = "own.toml"\n[axes]\nk = [-0.9, -0.1]\ntau = [0.5, 2.0, 7.0]\n');
make("trace.h5", "simulate", CASE);
const { browser, server } = await opened([folder]);

/** Opens a file of the folder by its name in the list. */
async function choose(page, name) {
  await page.locator("#to-maps").click();
  await page.locator("#maps").getByRole("button", { name, exact: true }).click();
}

/** The words of a command as they are typed, without the program. */
const argumentsOf = (command) => command.split(" ").slice(1);

/** What the panel tells of a point against the answer of a command. */
async function comparePanel(page, answer) {
  const point = await words(page, "point");
  const count = `${answer.n_unstable} unstable root${answer.n_unstable === 1 ? "" : "s"}`;
  assert.ok(point.includes(`${answer.stable ? "stable" : "unstable"}, ${count}`), point);
  const shown = await page.evaluate(() => window.slipmap.panel.point);
  for (const key of ["abscissa", "delay_margin", "stable_delays", "roots", "parameters", "system"])
    assert.deepEqual(shown[key], answer[key], key);
}

/** Waits until the point of another text than before is shown, and tells its text. */
async function pointOf(page) {
  await eventually(async () => assert.ok(await page.evaluate(() => window.slipmap.panel.point)));
  return page.evaluate(() => window.slipmap.panel.text);
}

test("a cell of a map of a system is what the command says of it", async () => {
  const page = await openPage(browser, server.link);
  await choose(page, "lobes.h5");
  await settled(page);
  await pointOf(page);
  const command = await page.locator("#command").inputValue();
  assert.match(command, /^slipmap point --system=turning .*--roots=16$/);
  await comparePanel(page, asked(argumentsOf(command)));
  const cell = await page.evaluate(() => window.slipmap.saved.place.values);
  const at = Object.entries(cell).flatMap(([name, value]) => ["--at", `${name}=${value}`]);
  const map = join(folder, "lobes.h5");
  await comparePanel(page, asked(["point", "--map", map, ...at, "--roots=16"]));
  assert.match(await words(page, "point"), /Turning with one mode[^]*zeta\s+0\.04/);
  assert.equal(await words(page, "sliding-title"), "System");
  for (const card of ["vc-card", "motion-card", "point-none"])
    assert.ok(await page.locator(`#${card}`).isHidden(), card);
  await picture(page, "system-map");
  // Of a system that is no part of the program, the text is saved and named.
  await choose(page, "own.h5");
  await settled(page);
  await eventually(async () => assert.match(await words(page, "point"), /Mine/));
  const named = await page.locator("#command").inputValue();
  assert.equal(named, "slipmap point --setting=point.toml --roots=16");
  await page.locator("#same-card summary").click();
  const place = join(newFolder(), "point.toml");
  writeFileSync(place, await page.locator("#toml").inputValue());
  await comparePanel(page, asked(["point", `--setting=${place}`, "--roots=16"]));
  assert.match(await words(page, "point"), /latency margin/);
  assert.match(await words(page, "intervals"), /stable latencies/);
  assert.deepEqual(page.faults, []);
  assert.deepEqual(await violations(page), []);
});

test("a trace is listed as such and shown as its motion", async () => {
  const page = await openPage(browser, server.link);
  await page.locator("#to-maps").click();
  const row = page.locator("#maps tr", { hasText: "trace.h5" });
  await eventually(async () => assert.match(await row.innerText(), /trace\s[^]*sliding/));
  await page.locator("#to-maps").click();
  await choose(page, "trace.h5");
  const told = asked(["info", join(folder, "trace.h5")]);
  await eventually(async () => {
    const outcome = await words(page, "outcome");
    assert.ok(outcome.includes(`${told.outcome}, known at t = ${told.decided.toPrecision(5)}`));
  });
  assert.equal(await words(page, "chart-title"), told.case.title);
  assert.equal(await words(page, "point-origin"), "from the file");
  const [samples, last] = await page.evaluate(() => {
    const { t, x_dot: u } = window.slipmap.panel.motion.motion.arrays;
    return [t.length, [t[t.length - 1], u[0]]];
  });
  assert.deepEqual([samples, ...last], [told.samples, 150, 0.3535]);
  assert.ok(await page.locator("#time canvas").isVisible());
  for (const id of ["chart", "sliding-card", "vc-card", "point-none", "field", "slice"])
    assert.ok(await page.locator(`#${id}`).isHidden(), id);
  // There is no other start, and the case is the whole one.
  assert.ok(await page.locator("#start-u").isDisabled());
  await page.locator("#phase").click({ position: { x: 100, y: 60 } });
  assert.equal(await page.evaluate(() => window.slipmap.panel.motion.start[0]), 0.3535);
  await page.locator("#same-card summary").click();
  assert.equal(await page.locator("#case").inputValue(), CASE);
  await picture(page, "trace");
  assert.deepEqual(await violations(page), []);
  // Its address shows it again, and nothing of it stays elsewhere.
  const { hash } = new URL(page.url());
  await show(page, "#v=1");
  assert.ok(await page.locator("#chart").isVisible());
  assert.equal(await words(page, "point-title"), "At the point");
  await page.evaluate((to) => (location.hash = to), hash);
  await eventually(async () => assert.equal(await words(page, "point-title"), "The trace"));
  await choose(page, "lobes.h5");
  await settled(page);
  assert.ok(await page.locator("#chart").isVisible());
  assert.ok(await page.locator("#motion-card").isHidden());
  assert.deepEqual(page.faults, []);
});

/** A view of few roots, so that it is there soon. */
const TURNING = "#v=1&model=turning&x=turning-width,0,0.6&y=tau,1,16&turning-zeta=0.04&at=0.3,8.5";

/** The counts of some cells of the chart, with the values of its axes. */
const someCells = (page) =>
  page.evaluate(() => {
    const { plane } = window.slipmap.plane;
    const [xs, ys] = plane.axes.map(({ values }) => values);
    return [0.15, 0.5, 0.85].flatMap((x) =>
      [0.2, 0.6, 0.9].map((y) => {
        const [i, j] = [Math.floor(x * plane.nx), Math.floor(y * plane.ny)];
        return [xs[i], ys[j], plane.others.n_unstable[i * plane.ny + j]];
      }),
    );
  });

test("a system of the program is charted over its own parameters", async () => {
  const page = await openPage(browser, server.link);
  await show(page, TURNING);
  const flags = (width, tau) => ["--set=zeta=0.04", `--set=width=${width}`, `--tau=${tau}`];
  for (const [width, tau, n] of await someCells(page)) {
    const told = asked(["point", "--system=turning", ...flags(width, tau)]);
    assert.ok(told.marginal || told.n_unstable === n, `${width}, ${tau}: ${n}`);
  }
  const command = await page.locator("#command").inputValue();
  assert.equal(command, `slipmap point --system=turning ${flags(0.3, 8.5).join(" ")} --roots=16`);
  await comparePanel(page, asked(argumentsOf(command)));
  // What is about the block alone is not there.
  for (const id of ["control-part", "law-fields", "motion-card", "vc-card", "system-input"])
    assert.ok(await page.locator(`#${id}`).isHidden(), id);
  assert.match(await words(page, "model-told"), /Q = -width/);
  await picture(page, "system");
  assert.deepEqual(await violations(page), []);
  // A slider is one of the system's, and the address says it.
  await page.locator("#n-turning-zeta").fill("0.1");
  await settled(page);
  assert.match(page.url(), /turning-zeta=0\.1/);
  assert.match(await page.locator("#command").inputValue(), /--set=zeta=0\.1 /);
  // The sweep file is one that runs elsewhere.
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    page.getByRole("button", { name: "Sweep file" }).click(),
  ]);
  const sweep = readFileSync(await download.path(), "utf8");
  assert.match(sweep, /^system = "turning"\n/);
  // The block comes back as it was.
  await page.locator("#model").selectOption("");
  await settled(page);
  assert.equal(await page.locator("#axis-x").inputValue(), "alpha_v");
  assert.ok(await page.locator("#law").isVisible());
  assert.doesNotMatch(page.url(), /turning/);
  assert.deepEqual(page.faults, []);
});

test("every model begins with a chart", async () => {
  const page = await openPage(browser, server.link);
  const models = await page.locator("#model option").evaluateAll((all) => all.map((o) => o.value));
  assert.ok(models.length >= 10 && models[0] === "" && models.at(-1) === "file", models);
  const texts = await page.evaluate(async (names) => {
    const [{ sweepOf, pointTexts }, { stateOf }] = await Promise.all([
      import("./sweep.js"),
      import("./state.js"),
    ]);
    const { catalogue } = window.slipmap;
    return names.map((model) => {
      const known = catalogue.systems.find(({ name }) => name === model);
      const text = model === "file" ? catalogue.systems[0].toml : "";
      const system = text && `&system=${encodeURIComponent(text)}`;
      const state = stateOf(`#v=1&model=${model}${system}`, catalogue);
      const fields = catalogue.shown(state);
      const middle = [state.x, state.y].map(({ from, to }) => (from + to) / 2);
      const { point } = pointTexts(state, catalogue, middle);
      // Curves are looked at elsewhere.
      const sweep = sweepOf(state, catalogue, [4, 3], fields, false);
      return { model, notes: state.notes, point, sweep };
    });
  }, models);
  for (const { model, notes, point, sweep } of texts) {
    assert.deepEqual(notes, [], model);
    const answers = await page.evaluate(
      ([chart, at]) => {
        const { source } = window.slipmap;
        return Promise.all([source.chart(chart), source.point(at)]);
      },
      [sweep, point],
    );
    assert.ok(answers[0].fields.length >= 5 && "n_unstable" in answers[1], model);
  }
  assert.deepEqual(page.faults, []);
});

test("a system is pasted or chosen as a file, and a mistake is told in its place", async () => {
  const page = await openPage(browser, server.link);
  await show(page, TURNING);
  await page.locator("#model").selectOption("file");
  const text = page.locator("#system-text");
  // It begins with the file of the system that was looked at.
  assert.match(await text.inputValue(), /^# Regenerative chatter in turning with one mode/);
  await text.fill(OWN);
  await settled(page);
  await page.locator("#n-file-c").fill("0.5");
  await settled(page);
  const names = ["#axis-x", "#axis-y"].map((id) => page.locator(id).inputValue());
  assert.deepEqual(await Promise.all(names), ["file-k", "tau"]);
  const own = join(newFolder(), "own.toml");
  writeFileSync(own, OWN);
  for (const [k, tau, n] of await someCells(page)) {
    const sets = ["--set=c=0.5", `--set=k=${k}`];
    const told = asked(["point", `--system=${own}`, ...sets, `--tau=${tau}`]);
    assert.ok(told.marginal || told.n_unstable === n, `${k}, ${tau}: ${n}`);
  }
  const before = await words(page, "point");
  const { hash } = new URL(page.url());
  // A mistake is marked in its line; sliders stay meanwhile.
  await text.fill(OWN.replace("c*s", "cc*s"));
  await eventually(async () => {
    assert.equal(await page.locator("#system-mistake u").innerText(), "cc");
    assert.match(await words(page, "system-mistake"), /^line 2: [^]*unknown name/);
  });
  assert.equal(await text.getAttribute("aria-invalid"), "true");
  assert.ok(await page.locator("#n-file-c").isVisible());
  await eventually(async () => assert.match(await words(page, "problem"), /not understood/));
  await picture(page, "system-mistake");
  assert.deepEqual(await violations(page), []);
  // A system of nothing but a delay cannot be charted, and is told so.
  await text.fill('P = "s + 1"\nQ = "0.5"\n');
  await eventually(async () => assert.match(await words(page, "system-mistake"), /two parameters/));
  // The address brings it back.
  await show(page, "#v=1");
  await show(page, hash);
  await eventually(async () => assert.equal(await words(page, "point"), before));
  assert.equal(await text.inputValue(), OWN);
  assert.equal(await words(page, "system-mistake"), "");
  // So does a file; values that its parameters cannot have are left.
  const place = join(newFolder(), "tight.toml");
  writeFileSync(place, OWN.replace("minimum = 0", "minimum = 0, maximum = 0.45"));
  await page.locator("#system-file").setInputFiles(place);
  await settled(page);
  assert.match(await text.inputValue(), /maximum = 0\.45/);
  assert.equal(await page.locator("#n-file-c").inputValue(), "0.4");
  assert.equal(await words(page, "problem"), "");
  assert.deepEqual(
    page.faults.filter((fault) => !/422/.test(fault)),
    [],
  );
});

test("a law with a state has sliders, and no motions", async () => {
  const page = await openPage(browser, server.link);
  await page.locator("#law").selectOption("rate-and-state");
  await page.locator("#n-direct_effect").fill("0.2");
  await page.locator("summary", { hasText: "Memory, latency, lags" }).click();
  await page.locator("#n-latency").fill("0.1");
  await settled(page);
  await eventually(async () =>
    assert.match(await page.locator("#command").inputValue(), /--direct-effect=0\.2 /),
  );
  const command = await page.locator("#command").inputValue();
  assert.match(command, /--friction=rate-and-state .*--latency=0\.1/);
  await comparePanel(page, asked(argumentsOf(command)));
  for (const id of ["motion-card", "vc-card", "law-curve", "limits-sliders"])
    assert.ok(await page.locator(`#${id}`).isHidden(), id);
  await page.locator("#axis-x").selectOption("evolution_effect");
  await settled(page);
  assert.equal(await words(page, "problem"), "");
  assert.deepEqual(page.faults, []);
});

test("limits of the actuators are switched on and have sliders", async () => {
  const page = await openPage(browser, server.link);
  await show(page, "#v=1&control=velocity&law=weakening&x=alpha_v,-1,0.2&y=tau,0,12&at=-0.33,4.15");
  const case_ = page.locator("#case");
  assert.doesNotMatch(await case_.inputValue(), /v_max/);
  await page.locator("summary", { hasText: "Limits of the actuators" }).click();
  await page.locator("#on-v_max").check();
  await settled(page);
  await page.locator("#n-v_max").fill("0.4");
  await settled(page);
  await eventually(async () => assert.match(await case_.inputValue(), /^v_max = 0\.4$/m));
  const largest = () =>
    page.evaluate(() => Math.max(...window.slipmap.panel.motion.motion.arrays.v));
  await eventually(async () => assert.ok((await largest()) <= 0.4));
  assert.match(page.url(), /v_max=0\.4/);
  assert.deepEqual(await violations(page), []);
  const { hash } = new URL(page.url());
  await page.locator("#on-v_max").uncheck();
  await settled(page);
  assert.doesNotMatch(page.url(), /v_max/);
  assert.ok(await page.locator("#n-v_max").isHidden());
  await show(page, hash);
  assert.equal(await page.locator("#n-v_max").inputValue(), "0.4");
  assert.deepEqual(page.faults, []);
});
