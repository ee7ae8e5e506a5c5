// The live chart in a real browser: what is on the screen is what slipmap says.

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import {
  atRest,
  chance,
  colourAt,
  newFolder,
  openPage,
  opened,
  placeOf,
  serve,
  slipmap,
} from "./support.mjs";

const { browser, server } = await opened();

const asked = (args) => JSON.parse(slipmap([...args, "--json"]));

/** Pixels by chance, each with the values of the cell that it shows, none at the edge of its cell. */
async function cellsByChance(page, count, seed) {
  const numbers = chance(seed);
  const chosen = Array.from({ length: 3 * count }, () => [
    numbers.next().value,
    numbers.next().value,
  ]);
  return page.evaluate(
    ([parts, wanted]) => {
      const { plane } = window.slipmap;
      const { ends, nx, ny, axes } = plane.plane;
      const area = plane.area();
      const found = [];
      for (const part of parts) {
        // The centre of a pixel of the screen.
        const sizes = [area.w, area.h];
        const middle = part.map((p, i) => (Math.floor(p * sizes[i]) + 0.5) / sizes[i]);
        const point = middle.map((p, i) => plane.view[i].value(p));
        const places = [ends[0].part(point[0]) * nx, ends[1].part(point[1]) * ny];
        if (places.some((place) => Math.abs(place - Math.round(place)) < 0.05)) continue;
        const cell = places.map(Math.floor);
        found.push({ point, values: cell.map((index, i) => axes[i].values[index]) });
        if (found.length === wanted) break;
      }
      return found;
    },
    [chosen, count],
  );
}

/** The colours of counts, as the legend shows them. */
const legend = (page) =>
  page.evaluate(() => {
    const { colours } = window.slipmap.plane.plane;
    return colours.colours.map((c) => [1, 3, 5].map((at) => parseInt(c.slice(at, at + 2), 16)));
  });

/** Pixels against the command; `flags` of a cell's values. */
async function compareWithCommand(page, count, seed, flags) {
  const [cells, colours] = [await cellsByChance(page, count, seed), await legend(page)];
  const seen = await colourAt(
    page,
    cells.map(({ point }) => point),
  );
  let compared = 0;
  const classes = new Set();
  cells.forEach(({ values }, i) => {
    const is = colours.findIndex((colour) => colour.every((c, k) => c === seen[i][k]));
    // A curve or the cross covers this pixel.
    if (is < 0) return;
    const { n_unstable: n, marginal } = asked(["point", ...flags(values)]);
    if (marginal) return;
    assert.equal(is, Math.min(4, Math.ceil(n / 2)), `${values}: ${n} unstable roots`);
    compared += 1;
    classes.add(is);
  });
  assert.ok(compared >= 0.85 * count, `${compared} of ${count} pixels could be compared`);
  return { compared, classes };
}

const velocity = ([gain, tau]) => ["--mu-prime=-0.3", `--alpha-v=${gain}`, `--tau=${tau}`];

async function set(page, name, value) {
  await page.locator(`#p-${name}`).evaluate((slider, to) => {
    slider.parentElement.querySelector("input[type=number]").value = to;
    slider.parentElement.querySelector("input[type=number]").dispatchEvent(new Event("input"));
  }, value);
}

test("two hundred pixels of the first view are what the command says", async () => {
  const page = await openPage(browser, server.link);
  const { compared, classes } = await compareWithCommand(page, 210, 1, velocity);
  assert.ok(compared >= 200 && classes.size >= 3, `${compared}, ${[...classes]}`);
  assert.equal(new URL(page.url()).search, "", "the token has left the address");
  assert.deepEqual(page.faults, []);
});

test("so are they after a slider, under load control, and on logarithmic axes", async () => {
  const page = await openPage(browser, server.link);
  await set(page, "mu_prime", -0.6);
  await atRest(page);
  const slope = ([gain, tau]) => ["--mu-prime=-0.6", `--alpha-v=${gain}`, `--tau=${tau}`];
  await compareWithCommand(page, 40, 2, slope);
  await page.getByRole("radio", { name: "load" }).check();
  await atRest(page);
  const load = ([gain, tau]) => ["--mu-prime=-0.6", `--alpha-n=${gain}`, `--tau=${tau}`];
  await compareWithCommand(page, 40, 3, load);
  await page.getByRole("checkbox", { name: "logarithmic" }).nth(1).check();
  await atRest(page);
  assert.match(page.url(), /y=tau,[\d.]+,12,log/);
  await compareWithCommand(page, 40, 4, load);
  assert.deepEqual(page.faults, []);
});

test("a slider that is dragged ends with the chart of where it ends", async () => {
  const page = await openPage(browser, server.link);
  const box = await page.locator("#p-mu_prime").boundingBox();
  const y = box.y + box.height / 2;
  await page.mouse.move(box.x + 0.45 * box.width, y);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.2 * box.width, y, { steps: 30 });
  await page.mouse.up();
  await atRest(page);
  const slope = await page.locator("#p-mu_prime").inputValue();
  assert.ok(Number(slope) < -0.6, slope);
  await compareWithCommand(page, 40, 5, ([gain, tau]) => [
    `--mu-prime=${slope}`,
    `--alpha-v=${gain}`,
    `--tau=${tau}`,
  ]);
});

test("curves on the screen are where the count changes", async () => {
  const page = await openPage(browser, server.link);
  const vertices = await page.evaluate(() => {
    const curves = window.slipmap.plane.plane.curves.filter((c) => c.stable_side !== 0);
    return curves.flatMap(({ values }) => {
      const middle = 2 * Math.floor(values.length / 4);
      return [[values[middle], values[middle + 1]]];
    });
  });
  assert.ok(vertices.length >= 2);
  for (const [gain, tau] of vertices.filter(([, tau]) => tau > 0 && tau < 12)) {
    const counts = [-1e-4, 1e-4].map(
      (off) => asked(["point", ...velocity([gain, tau + off])]).n_unstable,
    );
    assert.notEqual(counts[0] === 0, counts[1] === 0, `${gain}, ${tau}: ${counts}`);
    const [[r, g, b]] = await colourAt(page, [[gain, tau]]);
    assert.ok(r + g + b < 450, `a dark line at ${gain}, ${tau}: ${[r, g, b]}`);
  }
});

test("the view is dragged and zoomed, and stays true", async () => {
  const page = await openPage(browser, server.link);
  const [from, to] = [await placeOf(page, [-1, 6]), await placeOf(page, [-0.8, 5])];
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await page.mouse.move(to.x, to.y, { steps: 5 });
  await page.mouse.up();
  await atRest(page);
  const ends = () =>
    page.evaluate(() => window.slipmap.plane.view.map(({ from: a, to: b }) => [a, b]));
  const moved = await ends();
  assert.ok(Math.abs(moved[0][0] + 1.8) < 0.01 && Math.abs(moved[1][0] - 1) < 0.03, `${moved}`);
  const at = await placeOf(page, [-0.4, 4]);
  await page.locator("#chart").focus();
  await page.mouse.move(at.x, at.y);
  for (let k = 0; k < 6; k++) await page.mouse.wheel(0, -120);
  await atRest(page);
  const zoomed = await ends();
  assert.ok(zoomed[0][1] - zoomed[0][0] < 0.6, `${zoomed}`);
  assert.ok(zoomed[0][0] < -0.4 && zoomed[0][1] > -0.4, `${zoomed}`);
  await compareWithCommand(page, 40, 6, velocity);
  await page.getByRole("button", { name: "All" }).click();
  await atRest(page);
  assert.deepEqual(await ends(), [
    [-1.6, 0.4],
    [0, 12],
  ]);
  assert.deepEqual(page.faults, []);
});

test("a cell that is clicked is what the copied command says", async () => {
  const page = await openPage(browser, server.link);
  const at = await placeOf(page, [-0.5, 3.2]);
  await page.mouse.click(at.x, at.y);
  await page.waitForFunction(() =>
    /alpha-v=-0\.(49|5)/.test(document.getElementById("command").value),
  );
  const command = (await page.locator("#command").inputValue()).split(" ");
  assert.equal(command.shift(), "slipmap");
  const told = asked(command);
  const words = await page.locator("#point").innerText();
  assert.equal(told.n_unstable, 0);
  assert.match(words, /stable, 0 unstable roots/);
  const margin = Number(told.delay_margin.toPrecision(6));
  assert.ok(words.includes(String(margin)), `${words} has the margin ${margin}`);
  const [from, to] = told.stable_delays[0].map((x) => Number(x.toPrecision(6)));
  assert.match(await page.locator("#intervals").innerText(), new RegExp(`${from} < τ < ${to}`));
  const toml = await page.locator("#toml").inputValue();
  assert.match(toml, /\[fixed\]\nmu_prime = -0.3\nalpha_v = -0\.\d+\ntau = \d\.\d+/);
});

test("everything can be done by keyboard", async () => {
  const page = await openPage(browser, server.link);
  for (let k = 0; k < 40; k++) {
    await page.keyboard.press("Tab");
    if (await page.evaluate(() => document.activeElement.id === "chart")) break;
  }
  assert.equal(await page.evaluate(() => document.activeElement.id), "chart");
  const point = () => page.evaluate(() => window.slipmap.plane.point);
  const begun = await point();
  for (const key of ["ArrowRight", "ArrowRight", "ArrowUp", "Shift+ArrowLeft"])
    await page.keyboard.press(key);
  const moved = await point();
  assert.ok(Math.abs(moved[0] - (begun[0] - 0.08 * 2)) < 1e-6, `${begun} ${moved}`);
  assert.ok(Math.abs(moved[1] - (begun[1] + 0.01 * 12)) < 1e-6, `${begun} ${moved}`);
  const { n_unstable: n } = asked(["point", ...velocity(moved)]);
  const words = n === 0 ? "stable" : `${n} unstable roots`;
  assert.match(await page.locator("#readout").innerText(), new RegExp(words));
  await page.keyboard.press("Enter");
  const flag = `--alpha-v=${moved[0]}`;
  await page.waitForFunction(
    (text) => document.getElementById("command").value.includes(text),
    flag,
  );
  await page.keyboard.press("+");
  await atRest(page);
  const width = () =>
    page.evaluate(() => window.slipmap.plane.view[0].to - window.slipmap.plane.view[0].from);
  assert.ok((await width()) < 1.4);
  await page.keyboard.press("0");
  await atRest(page);
  assert.ok(Math.abs((await width()) - 2) < 1e-9);
});

test("the address holds the whole view", async () => {
  const page = await openPage(browser, server.link);
  await set(page, "mu_prime", -0.55);
  await page.getByRole("radio", { name: "load" }).check();
  await page.locator("#show").selectOption("abscissa");
  await atRest(page);
  const at = await placeOf(page, [-1.5, 2]);
  await page.mouse.click(at.x, at.y);
  await page.waitForTimeout(600);
  const address = page.url();
  assert.match(
    address,
    /#v=1&control=load&x=alpha_n,-3,1&y=tau,0,12&mu_prime=-0.55&show=abscissa&at=/,
  );
  assert.ok(address.length < 200, address);
  const picture = () => page.evaluate(() => document.getElementById("chart").toDataURL());
  const [before_, words] = [await picture(), await page.locator("#point").innerText()];
  await page.goto("about:blank");
  await page.goto(address);
  await atRest(page);
  await page.waitForTimeout(400);
  assert.equal(await page.locator("#point").innerText(), words);
  assert.ok((await picture()) === before_, "the same picture, pixel by pixel");
});

test("an address that makes no sense shows what it can", async () => {
  for (const fragment of [
    "#v=9&x=q",
    "#v=1&x=alpha_v,3,1&y=tau,,&mu_prime=x&at=1",
    "#&&==",
    "#v=1&law=<b>",
  ]) {
    const page = await openPage(browser, null);
    await page.goto(server.link);
    await page.goto(`http://127.0.0.1:${server.port}/${fragment}`);
    await page.waitForTimeout(300);
    assert.match(await page.locator("h1").innerText(), /slipmap/);
    assert.deepEqual(
      page.faults.filter((fault) => !/422|400/.test(fault)),
      [],
      fragment,
    );
    await page.context().close();
  }
});

/** What a button downloads. */
async function downloaded(page, button) {
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    page.getByRole("button", { name: button, exact: true }).click(),
  ]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}

test("what is seen can be taken along", async () => {
  const page = await openPage(browser, server.link);
  const png = await downloaded(page, "PNG");
  assert.equal(png.name, "slipmap-chart.png");
  assert.deepEqual(
    [...png.bytes.subarray(1, 4)].map((c) => String.fromCharCode(c)).join(""),
    "PNG",
  );
  const svg = (await downloaded(page, "SVG")).bytes.toString();
  assert.match(svg, /^<svg xmlns=/);
  const drawn = await page.evaluate((text) => {
    const parsed = new DOMParser().parseFromString(text, "image/svg+xml");
    return ["parsererror", "polyline", "image", "text"].map(
      (tag) => parsed.querySelectorAll(tag).length,
    );
  }, svg);
  assert.ok(drawn[0] === 0 && drawn[1] > 10 && drawn[2] === 1 && drawn[3] > 10, `${drawn}`);
  const csv = (await downloaded(page, "CSV")).bytes.toString().trim().split("\n");
  const rows = csv.filter((line) => !line.startsWith("#"));
  assert.equal(rows[0], "alpha_v,tau,n_unstable,status");
  assert.equal(rows.length, 1 + 800 * 600);
  for (const k of [1, 12345, 333333, 480000]) {
    const [gain, tau, n] = rows[k].split(",").map(Number);
    assert.equal(asked(["point", ...velocity([gain, tau])]).n_unstable, n, rows[k]);
  }
  const toml = await downloaded(page, "Sweep file");
  const folder = newFolder();
  const file = join(folder, toml.name);
  writeFileSync(file, toml.bytes);
  slipmap(["run", file, "-o", join(folder, "map.h5")]);
  const told = slipmap(["info", join(folder, "map.h5")]);
  assert.match(told, /480.000/);
});

test("a friction law brings its curve, critical velocity and motions", async () => {
  const page = await openPage(browser, server.link);
  await page.locator("#law").selectOption("weakening");
  await atRest(page);
  await page.waitForFunction(() => /0\.34/.test(document.getElementById("vc").innerText));
  const law = ["--friction=weakening", "--mu0=0.5", "--v-s=0.5", "--alpha-v=-0.33", "--tau=4.15"];
  const found = asked(["vc", ...law]);
  const words = await page.locator("#vc").innerText();
  assert.ok(words.includes(Number(found.vc.toPrecision(6))), words);
  assert.match(await page.locator("#law-told").innerText(), /slope μ′ = −0.346/);
  await page.waitForFunction(() => window.slipmap.panel.motion.motion);
  const folder = newFolder();
  const motion = async () => {
    const file = join(folder, "case.toml");
    writeFileSync(file, await page.locator("#case").inputValue());
    const told = asked([
      "simulate",
      file,
      "-o",
      join(folder, "t.h5"),
      "--picture",
      join(folder, "t.png"),
      "--fresh",
    ]);
    const shown = await page.evaluate(() => {
      const { outcome, decided } = window.slipmap.panel.motion.motion;
      return { outcome, decided };
    });
    assert.deepEqual(shown, { outcome: told.outcome, decided: told.decided });
    return shown;
  };
  const first = await motion();
  const box = await page.locator("#phase").boundingBox();
  await page.locator("#phase").scrollIntoViewIfNeeded();
  const again = await page.locator("#phase").boundingBox();
  await page.mouse.move(again.x + 0.5 * box.width, again.y + 0.4 * box.height);
  await page.mouse.down();
  await page.mouse.move(again.x + 0.6 * box.width, again.y + 0.3 * box.height, { steps: 4 });
  await page.mouse.up();
  await page.waitForTimeout(500);
  const second = await motion();
  assert.notEqual(first.decided, second.decided);
  assert.match(page.url(), /start=-?[\d.]+,-?[\d.]+/);
  assert.deepEqual(page.faults, []);
});

test("a measured law is pasted as CSV, and a mistake in it is told", async () => {
  const page = await openPage(browser, server.link);
  await page.locator("#law").selectOption("table");
  await page.locator("#law-table").fill("v, mu\n0, 0.52\n0.1 0.41\n0.3;0.33\n1.0, 0.36\n");
  await atRest(page);
  await page.waitForFunction(() => /slope/.test(document.getElementById("law-told").innerText));
  const folder = newFolder();
  writeFileSync(join(folder, "law.csv"), "0 0.52\n0.1 0.41\n0.3 0.33\n1.0 0.36\n");
  const flags = [
    "--friction=table",
    `--table=${join(folder, "law.csv")}`,
    "--v0=0.35",
    "--alpha-v=-0.33",
    "--tau=4.15",
  ];
  const { mu_prime: slope } = asked(["point", ...flags]);
  const told = await page.locator("#law-told").innerText();
  assert.ok(told.includes(String(Number(Math.abs(slope).toPrecision(6)))), `${told} ${slope}`);
  assert.match(page.url(), /table=/);
  await page.locator("#law-table").fill("0, 0.5\nx\n");
  await page.waitForFunction(() => /table/.test(document.getElementById("problem").innerText));
});

test("units label axes and numbers", async () => {
  const page = await openPage(browser, server.link);
  await page.getByText("Mass, spring, load, units").click();
  await page.locator("#units").selectOption("N,m,s");
  await atRest(page);
  const axes = await page.evaluate(() => window.slipmap.plane.plane.axes.map(({ unit }) => unit));
  assert.deepEqual(axes, ["s-1", "s"]);
  assert.match(await page.locator("#readout").innerText(), /τ = 4.15 s/);
});

test("the page goes on when its server is back", async () => {
  const own = await serve();
  const page = await openPage(browser, own.link);
  own.child.kill("SIGKILL");
  await set(page, "mu_prime", -0.5);
  await page.getByText("The server does not answer").waitFor();
  const anew = await serve([], own.port);
  await page.getByText("The server was started anew").waitFor();
  const other = await page.context().newPage();
  await other.goto(anew.link);
  await page.locator("#gone").waitFor({ state: "hidden" });
  await atRest(page);
  await compareWithCommand(page, 20, 8, ([gain, tau]) => [
    "--mu-prime=-0.5",
    `--alpha-v=${gain}`,
    `--tau=${tau}`,
  ]);
  await anew.end();
});

test("another site's page can do nothing", async () => {
  const { createServer } = await import("node:http");
  const evil = createServer((_, response) => {
    response.setHeader("Content-Type", "text/html");
    response.end(
      `<form id="f" method="post" enctype="text/plain" action="http://127.0.0.1:${server.port}/api/v1/point">` +
        `<input name="[fixed]" value="1"></form>`,
    );
  });
  await new Promise((done) => evil.listen(0, "127.0.0.1", done));
  const page = await openPage(browser, server.link);
  const seen = [];
  page.on("response", (answer) => seen.push([new URL(answer.url()).pathname, answer.status()]));
  page.on("request", (request) =>
    assert.ok(!(request.headers().referer ?? "").includes("token"), "no token in Referer"),
  );
  await page.goto(`http://localhost:${evil.address().port}/`);
  const base = `http://127.0.0.1:${server.port}/api/v1/point`;
  const answers = await page.evaluate(async (address) => {
    const ask = (options) =>
      fetch(address, { method: "POST", body: "[fixed]", ...options }).then(
        (r) => r.type,
        () => "refused",
      );
    return [
      await ask({ credentials: "include" }),
      await ask({ credentials: "include", mode: "no-cors" }),
    ];
  }, base);
  assert.deepEqual(answers, ["refused", "refused"]);
  await page.evaluate(() => document.getElementById("f").submit());
  await page.waitForTimeout(300);
  const statuses = seen.filter(([path]) => path === "/api/v1/point").map(([, status]) => status);
  assert.ok(
    statuses.length >= 1 && statuses.every((status) => status === 401 || status === 403),
    `${statuses}`,
  );
  evil.close();
});
