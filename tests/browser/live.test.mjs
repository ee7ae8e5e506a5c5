// The live chart in a real browser: what is on the screen is what slipmap says.

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import {
  atRest,
  chance,
  colourAt,
  eventually,
  newFolder,
  openPage,
  opened,
  picture,
  placeOf,
  serve,
  settled,
  show,
  slipmap,
  violations,
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
    const { classes } = window.slipmap.plane.plane.field;
    return classes.map(({ colour: c }) => [1, 3, 5].map((at) => parseInt(c.slice(at, at + 2), 16)));
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
    assert.equal(is, Math.min(8, n), `${values}: ${n} unstable roots`);
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
    await page.waitForURL((url) => url.search === "");
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
  await page.locator("#law-table").fill("v; mu\n0; 0,52\n0,1; 0,41\n0,3;0,33\n1,0; 0,36\n");
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
  await page.waitForFunction(() => /1 point/.test(document.getElementById("problem").innerText));
});

const FORMULA = "mu0 + (mu_s - mu0)*exp(-(v/v_s)^p) + sigma*v";

test("a law is written as a formula, whose own parameters are sliders and axes", async () => {
  const page = await openPage(browser, server.link);
  await page.locator("#law").selectOption("formula");
  const formula = page.locator("#law-formula");
  assert.equal(await formula.inputValue(), "mu0 + (mu_s - mu0)*exp(-v/v_s)");
  await formula.fill(FORMULA);
  await page.locator("#n-p").fill("1.5");
  await page.locator("#n-sigma").fill("0.03");
  await settled(page);
  const flags = (sigma, more = []) => [
    "--friction=formula",
    `--mu-k=${FORMULA}`,
    "--mu0=0.5",
    "--v-s=0.5",
    "--v0=0.35",
    "--set=p=1.5",
    `--set=sigma=${sigma}`,
    ...more,
  ];
  const { mu_prime: slope } = asked(["point", ...flags(0.03)]);
  const digits = String(Number(Math.abs(slope).toPrecision(6)));
  await eventually(async () => assert.ok((await words(page, "law-told")).includes(digits)));
  assert.ok(await page.locator("#p-sigma").isVisible());
  // What was set comes back from the address.
  const { hash } = new URL(page.url());
  assert.match(hash, /own\.p=1\.5.*own\.sigma=0\.03.*formula=mu0/);
  const before = await words(page, "point");
  await show(page, "#v=1");
  await show(page, hash);
  await eventually(async () => assert.equal(await words(page, "point"), before));
  assert.equal(await page.locator("#n-p").inputValue(), "1.5");
  // A mistake is marked beside the field, in the words of slipmap; sliders stay meanwhile.
  await formula.fill(FORMULA.replace("exp", "exq"));
  await eventually(async () => {
    assert.equal(await page.locator("#formula-mistake u").innerText(), "exq");
    assert.match(await words(page, "formula-mistake"), /did you mean `exp`/);
  });
  assert.equal(await formula.getAttribute("aria-invalid"), "true");
  assert.ok(await page.locator("#p-sigma").isVisible());
  await picture(page, "formula-mistake");
  await formula.fill(FORMULA);
  await eventually(async () => assert.equal(await words(page, "formula-mistake"), ""));
  // From sigma = −1.76 on friction at v0 has a coefficient.
  await page.locator("#axis-x").selectOption("sigma");
  await page.locator("#axis-x-from").fill("-3");
  await page.locator("#axis-x-from").press("Enter");
  await settled(page);
  await picture(page, "formula");
  const cells = await page.evaluate(() => {
    const { plane } = window.slipmap.plane;
    const [sigmas, taus] = plane.axes.map(({ values }) => values);
    return [0.1, 0.5, 0.9].flatMap((x) =>
      [0.2, 0.8].map((y) => {
        const [i, j] = [Math.floor(x * plane.nx), Math.floor(y * plane.ny)];
        const n = i * plane.ny + j;
        const [count, flags] = [plane.others.n_unstable[n], plane.flags(n)];
        return { sigma: sigmas[i], tau: taus[j], count, flags };
      }),
    );
  });
  const outside = ({ flags: of }) => of.includes("outside the model");
  for (const { sigma, tau, count, flags: of } of cells) {
    if (sigma < -1.8) {
      assert.ok(outside({ flags: of }) && count === 65535, `${sigma} ${tau}`);
    } else {
      const more = ["--alpha-v=-0.33", `--tau=${tau}`];
      assert.equal(asked(["point", ...flags(sigma, more)]).n_unstable, count, `${sigma} ${tau}`);
    }
  }
  assert.equal(cells.filter(outside).length, 2);
  assert.deepEqual(await violations(page), []);
  assert.deepEqual(page.faults.filter((fault) => !/422/.test(fault)), []);
});

test("units label axes and numbers", async () => {
  const page = await openPage(browser, server.link);
  await page.getByText("Mass, spring, load, dashpots, units").click();
  await page.locator("#units").selectOption("N,m,s");
  await settled(page);
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

test("the link opens from a file and from another site's page", async () => {
  const { createServer } = await import("node:http");
  const file = join(newFolder(), "link.html");
  writeFileSync(file, `<meta http-equiv="refresh" content="0; url=${server.link}">`);
  const site = createServer((_, response) => {
    response.setHeader("Content-Type", "text/html");
    response.end(`<a href="${server.link}">slipmap</a>`);
  });
  await new Promise((done) => site.listen(0, "127.0.0.1", done));
  for (const from of [`file://${file}`, `http://localhost:${site.address().port}/`]) {
    const page = await openPage(browser, null);
    await page.goto(from);
    if (from.startsWith("http")) await page.getByRole("link").click();
    await page.waitForURL((url) => url.port === String(server.port) && url.search === "");
    await atRest(page);
    assert.deepEqual(page.faults, []);
  }
  site.closeAllConnections();
  site.close();
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

const words = (page, id) => page.locator(`#${id}`).innerText();
const axes = (page) => page.evaluate(() => [window.slipmap.state.x, window.slipmap.state.y]);
const minus = (x) => String(x).replace("-", "−");

test("the readout says what the panel says, of a point and of a cell", async () => {
  const page = await openPage(browser, server.link);
  await settled(page);
  const agree = async (point, flags = velocity(point)) => {
    const { n_unstable: n, abscissa } = asked(["point", ...flags]);
    const count = n === 0 ? "stable" : `${n} unstable root`;
    const digits = minus(Number(abscissa.toPrecision(6)));
    const [readout, panel] = [await words(page, "readout"), await words(page, "point")];
    assert.ok(
      readout.includes(count) && readout.includes(digits),
      `${readout}: ${count} ${digits}`,
    );
    assert.ok(panel.includes(`${n} unstable root`) && panel.includes(digits), panel);
  };
  await agree([-0.33, 4.15]);
  await show(page, "#v=1&at=-0.9,4.42973");
  await agree([-0.9, 4.42973]);
  // A cell is told by its own values.
  const place = await placeOf(page, [-0.7123, 3.777]);
  await page.mouse.move(place.x, place.y);
  const told = await words(page, "hover");
  const numbers = told
    .replaceAll("−", "-")
    .match(/= (-?[\d.]+), τ = ([\d.]+): .*abscissa (-?[\d.]+)/);
  const { abscissa } = asked(["point", ...velocity(numbers.slice(1, 3))]);
  assert.ok(Math.abs(abscissa - Number(numbers[3])) < 1e-5, `${told}: ${abscissa}`);
  // The point is out of view, and something else changes.
  await show(page, "#v=1&x=alpha_v,-1.6,-0.8&at=-0.33,4.15");
  await set(page, "mu_prime", -0.9);
  await page.waitForTimeout(50);
  await settled(page);
  await agree(null, ["--mu-prime=-0.9", "--alpha-v=-0.33", "--tau=4.15"]);
  // What is amiss with a cell is told.
  await show(page, "#v=1&x=mu_prime,-0.4,0.399&y=tau,0,12&alpha_v=0&at=0,3");
  assert.match(await words(page, "readout"), /marginal/);
  const zero = await placeOf(page, [0, 6]);
  await page.mouse.move(zero.x, zero.y);
  assert.match(await words(page, "hover"), /marginal/);
  assert.deepEqual(page.faults, []);
});

test("a point that cannot be is told as such, and nothing of another one is left", async () => {
  const page = await openPage(browser, server.link);
  await settled(page);
  await show(page, "#v=1&at=-0.33,-5");
  const told = () => words(page, "point-problem");
  assert.match(await told(), /tau = -5 is outside its range/);
  assert.match(await words(page, "point-where"), /τ = −5/);
  assert.ok(await page.locator("#cards").isHidden());
  // Another chart does not wipe it away.
  await set(page, "mu_prime", -0.4);
  await page.waitForTimeout(50);
  await settled(page);
  assert.match(await told(), /tau = -5/);
  assert.equal(await words(page, "problem"), "");
  await show(page, "#v=1&law=weakening&at=-0.5,3&start=1e300,0");
  assert.equal(await told(), "");
  assert.match(await words(page, "motion-problem"), /x_dot0 = 1e300 is outside/);
  assert.ok(await page.locator("#point").isVisible());
  assert.equal(await words(page, "outcome"), "");
  await show(page, "#v=1&law=weakening&at=-0.5,3");
  assert.deepEqual(await page.evaluate(() => window.slipmap.panel.motion.start), [0, 0]);
  assert.match(await words(page, "outcome"), /known at/);
  await page.locator("#law").selectOption("table");
  await page.waitForTimeout(50);
  await settled(page);
  assert.match(await told(), /no line has two numbers/);
  assert.ok(await page.locator("#cards").isHidden());
});

test("pasted tables come back from their addresses, and mistakes are told by line", async () => {
  const page = await openPage(browser, server.link);
  await page.locator("#law").selectOption("table");
  const paste = async (text) => {
    await page.locator("#law-table").fill(text);
    await page.waitForTimeout(50);
    await settled(page);
  };
  for (const separator of [" ", "\t", ";", ", "]) {
    const rows = ["0 0.52", "0.1 0.41", "1 0.36"].map((row) => row.replace(" ", separator));
    await paste(rows.join("\n"));
    assert.match(decodeURIComponent(page.url()), /table=0[^=]*0.52\n0.1[^=]*0.41\n1[^=]*0.36/);
  }
  const [fragment, before] = [new URL(page.url()).hash, await words(page, "point")];
  await show(page, "#v=1");
  await show(page, fragment);
  assert.equal(await words(page, "point"), before);
  // There is no command for it, and so nothing to copy.
  assert.equal(await page.locator("#command").inputValue(), "");
  assert.ok(await page.locator("#copy-command").isDisabled());
  for (const [text, mistake] of [
    ["v;mu\n1,000;2\n2,000;1", /1,000 may be 1.000 or 1000/],
    ["v,mu\n0,0.5\n1,0\n2,0.3", /line 3, column 2 \(mu\): friction is greater than 0/],
    ["t,v,x\n0,1,0.5\n1,2,0.3", /which column is mu_k.*columns: 1 t, 2 v, 3 x/],
    ["v,F\n0,5\n2,3", /column 2 \(F\) is a force.*normal_load = 12.5/],
  ]) {
    await paste(text);
    assert.match(await words(page, "problem"), mistake);
  }
});

test("columns and the unit of a pasted table are typed, and what was done is told", async () => {
  const page = await openPage(browser, server.link);
  await page.locator("#law").selectOption("table");
  await page.locator("#law-table").fill("t,x,F,N\n0,10,2,4\n1,20,1,4\nend,,,\n");
  await page.locator("#law-columns").fill("speed=x,force=3,load=N");
  await page.locator("#units").evaluate((units) => {
    units.value = "N,m,s";
    units.dispatchEvent(new Event("change"));
  });
  await page.locator("#law-speed-unit").fill("cm/s");
  await page.waitForFunction(() =>
    /line 4 is left out/.test(document.getElementById("law-remarks").innerText),
  );
  await settled(page);
  assert.equal(await words(page, "problem"), "");
  const toml = await page.locator("#toml").inputValue();
  assert.match(toml, /columns = "speed=x,force=3,load=N", speed_unit = "cm\/s" }/);
  const address = page.url();
  assert.match(address, /columns=speed%3Dx,force%3D3,load%3DN&speed_unit=cm%2Fs/);
  const [fragment, before] = [new URL(address).hash, await words(page, "point")];
  await show(page, "#v=1");
  await show(page, fragment);
  assert.equal(await words(page, "point"), before);
  assert.equal(await page.locator("#law-columns").inputValue(), "speed=x,force=3,load=N");
});

test("axes are swapped, zoomed and moved within what there is", async () => {
  const page = await openPage(browser, server.link);
  const choose = async (control) => {
    await page.getByRole("radio", { name: control }).check();
    await atRest(page);
  };
  const times = async (count, button) => {
    for (let k = 0; k < count; k++) await page.locator(button).click();
    await atRest(page);
  };
  await choose("both");
  await page.locator("#axis-y").selectOption("alpha_n");
  await choose("velocity");
  assert.deepEqual(
    (await axes(page)).map(({ name }) => name),
    ["alpha_v", "tau"],
  );
  await choose("load");
  const all = await axes(page);
  await times(2, "#zoom-in");
  assert.notDeepEqual(await axes(page), all);
  await times(1, "#zoom-all");
  assert.deepEqual(await axes(page), all);
  // A drag beyond τ = 0 moves, and does not zoom.
  const [from, to] = [await placeOf(page, [-2, 2]), await placeOf(page, [-2, 8])];
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await page.mouse.move(to.x, to.y, { steps: 4 });
  await page.mouse.up();
  assert.deepEqual((await axes(page))[1], all[1]);
  await page.locator("#axis-y-log").check();
  const shown = [];
  for (let k = 0; k < 3; k++) {
    await times(1, "#zoom-out");
    shown.push((await axes(page))[1]);
  }
  assert.ok(
    shown.every(({ from: low }, k) => low > 0 && (!k || low < shown[k - 1].from)),
    shown,
  );
  assert.equal(await words(page, "problem"), "");
  await times(1, "#zoom-all");
  assert.deepEqual((await axes(page))[1], { ...all[1], from: 0.012, log: true });
  assert.deepEqual(page.faults, []);
});

test("every pair of axes begins with a chart, whatever the law", async () => {
  const page = await openPage(browser, server.link);
  const [count, failures] = await page.evaluate(async () => {
    const { catalogue, state, source } = window.slipmap;
    const { parametersOf, sweepOf } = await import("./sweep.js");
    const table = "0, 0.52\n0.1, 0.41\n1, 0.36";
    const left = [];
    for (const law of ["none", ...catalogue.laws.map(({ name }) => name)]) {
      // Both controls have the gains of each.
      const begun = { ...state, control: "mixed", law, table, values: {} };
      const names = parametersOf(begun, catalogue);
      for (const x of names) {
        for (const y of names) {
          // Chosen one after the other; the order matters to friction coefficients only.
          if (x === y || (x > y && !/^mu/.test(x + y))) continue;
          const other = catalogue.axis(y, begun, { name: "" }, 0.52);
          const view = { ...begun, x: catalogue.axis(x, begun, other, 0.52), y: other };
          // Curves depend on the slope alone, so those of one law will do; with a state they take long.
          const curved = law === "weakening" && !catalogue.isGeneral(view);
          left.push(sweepOf(view, catalogue, [3, 3], ["n_unstable"], curved));
        }
      }
    }
    const [size, wrong] = [left.length, []];
    const some = async () => {
      for (let text = left.pop(); text; text = left.pop())
        await source.chart(text).catch(({ message }) => wrong.push([message, text]));
    };
    await Promise.all([some(), some(), some()]);
    return [size, wrong.slice(0, 5)];
  });
  assert.deepEqual(failures, []);
  assert.ok(count > 200, `${count}`);
});

test("what an address asks for and there is not is told in words", async () => {
  const page = await openPage(browser, server.link);
  for (const [fragment, told] of [
    ["#v=1&x=alpha_v,-Infinity,0.4", /axis across, alpha_v from -Infinity to 0.4: outside/],
    ["#v=1&x=tau,0,1&y=tau,0,2", /both axes are the same/],
    ["#v=1&x=alpha_v,0,1e-320", /too narrow/],
    ["#v=1&x=foo,0,1", /axis across, "foo", is no parameter/],
    ["#v=1&x=constructor,0,1", /"constructor", is no parameter/],
    ["#v=1&y=mass,-1,1", /axis upwards, mass from -1 to 1: outside its range: greater than 0/],
    ["#v=1&x=alpha_v,-1,1,log", /does not reach 0/],
    ["#v=1&units=foo", /"foo" is no units/],
    ["#v=1&law=weakening&show=vc", /"vc" is no field/],
    ["#v=1&mu_prime=1e300", /mu_prime = 1e300 is outside its range/],
    ["#v=2", /none of this version/],
  ]) {
    const notes = await page.evaluate(async (hash) => {
      const { stateOf } = await import("./state.js");
      return stateOf(hash, window.slipmap.catalogue).notes.join();
    }, fragment);
    assert.match(notes, told, fragment);
  }
  await show(page, "#v=1&x=tau,0,1&y=tau,0,2&law=q&mass=-1");
  assert.match(
    await words(page, "address-told"),
    /"q" is no friction law.*; mass = -1 is.*; both axes/,
  );
  assert.equal(await words(page, "problem"), "");
  assert.ok(await page.locator("#cards").isVisible());
  await show(page, "#v=1");
  assert.equal(await words(page, "address-told"), "");
  // A map that is not there leaves nothing to be moved.
  await page.evaluate(() => (location.hash = "#v=1&map=0000000000000000"));
  await page.waitForFunction(() => /no map/.test(document.getElementById("problem").innerText));
  assert.ok(await page.locator("#cards").isHidden());
  await page.locator("#chart").focus();
  for (const key of ["+", "0", "ArrowLeft", "Enter"]) await page.keyboard.press(key);
  const missing = page.faults.filter((fault) => !/404/.test(fault));
  assert.deepEqual(missing, []);
});

test("a start is dragged while something is looked at, and a key asks for no more than it must", async () => {
  const page = await openPage(browser, server.link);
  await show(page, "#v=1&law=weakening");
  await page.locator("#phase").scrollIntoViewIfNeeded();
  const box = await page.locator("#phase").boundingBox();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.4 * box.height);
  await page.mouse.down();
  // As when a map is looked at that grows.
  await page.evaluate(() => {
    const { panel, state } = window.slipmap;
    const { texts, where } = panel.next;
    const other = (text) => text.replace("4.15", "4.05");
    const [point, vc, motion] = [texts.point, texts.vc, texts.motion].map(other);
    panel.look({ point, vc, motion }, { where, start: state.start });
  });
  await page.mouse.move(box.x + 0.6 * box.width, box.y + 0.3 * box.height, { steps: 4 });
  await page.mouse.up();
  await page.waitForTimeout(300);
  await settled(page);
  assert.deepEqual(page.faults, []);
  const questions = [];
  page.on("request", (request) => questions.push(new URL(request.url()).pathname));
  await page.locator("#phase").focus();
  await page.keyboard.press("ArrowUp");
  await page.waitForTimeout(300);
  await settled(page);
  // The list of maps is looked at from time to time, but not by a key.
  const [asked, list] = [questions.filter((path) => /api/.test(path)), "/api/v1/maps"];
  assert.deepEqual(asked.filter((path) => path !== list), ["/api/v1/motion"]);
  assert.ok(asked.filter((path) => path === list).length <= 1, `${asked}`);
});

test("pictures have a ground in the dark, and a copy that fails is told", async () => {
  const page = await openPage(browser, server.link, { colorScheme: "dark" });
  await settled(page);
  const { bytes } = await downloaded(page, "PNG");
  const corner = await page.evaluate(async (base64) => {
    const image = new Image();
    image.src = `data:image/png;base64,${base64}`;
    await image.decode();
    const context = new OffscreenCanvas(8, 8).getContext("2d");
    context.drawImage(image, 0, 0);
    return Array.from(context.getImageData(2, 2, 1, 1).data);
  }, bytes.toString("base64"));
  // Files are on paper, whatever the page has.
  assert.deepEqual(corner, [255, 255, 255, 255]);
  const light = await openPage(browser, server.link, { colorScheme: "light" });
  await settled(light);
  assert.ok(bytes.equals((await downloaded(light, "PNG")).bytes));
  const button = page.locator("#copy-link");
  await button.click();
  await button.click();
  await page.waitForFunction(() => document.getElementById("copy-link").innerText === "Copied");
  assert.equal(await page.evaluate(() => navigator.clipboard.readText()), page.url());
  await page.waitForFunction(() => document.getElementById("copy-link").innerText === "Copy link");
  await page.evaluate(() => {
    Object.defineProperty(navigator, "clipboard", { value: undefined });
    window.selected = null;
    document.execCommand = () => {
      window.selected = document.activeElement.value;
      return false;
    };
  });
  await button.click();
  await page.waitForFunction(() => document.getElementById("copy-link").innerText === "Not copied");
  assert.equal(await page.evaluate(() => window.selected), page.url());
  assert.ok(await button.evaluate((it) => it === document.activeElement));
});

test("the panel's numbers have the units of the model", async () => {
  const page = await openPage(browser, server.link);
  await show(page, "#v=1&law=weakening&units=mN,mm,s&at=-0.33,4.15");
  assert.match(await words(page, "point-where"), /α_v = −0.33 s-1, τ = 4.15 s/);
  const told = await words(page, "point");
  for (const part of [
    /slope μ′\s+−0.34\d+ mm-1 s/,
    /margin\s+[\d.]+ s/,
    /abscissa\s+−[\d.]+ s-1/,
  ]) {
    assert.match(told, part);
  }
  assert.match(
    await words(page, "vc"),
    /velocity\s+0.34\d+ mm s-1.*stuck [\d.]+ s, slipping [\d.]+ s/s,
  );
  assert.match(await words(page, "outcome"), /at t = [\d.]+ s\s.*load\s+[\d.]+ mN/s);
  assert.match(await words(page, "readout"), /spectral abscissa −[\d.]+ s-1/);
  assert.match(await words(page, "law-told"), /at v0 = 0.35 mm s-1/);
  const command = (await page.locator("#vc-command").inputValue()).split(" ");
  assert.equal(command.shift(), "slipmap");
  assert.ok((await words(page, "vc")).includes(Number(asked(command).vc.toPrecision(6))));
});

test("kinds and numbers of unstable roots have colours and words of their own", async () => {
  const page = await openPage(browser, server.link);
  const [kinds, counts, names] = await page.evaluate(async () => {
    const { coloursOf } = await import("./colours.js");
    const { fields } = window.slipmap.catalogue;
    const of = (wanted) => fields.find(({ name }) => name === wanted);
    const { shown } = window.slipmap.plane.plane;
    const [outcome, count] = ["outcome", "n_unstable"].map((name) => coloursOf(of(name), shown));
    const pixels = (colours, n) => Array.from({ length: n }, (_, number) => colours.pixel(number));
    const words = [0, 1, 12, 65534, NaN].map((n) => count.name(n));
    return [pixels(outcome, 14), pixels(count, 9), [...words, outcome.name(3)]];
  });
  assert.equal(new Set(kinds).size, 14);
  assert.equal(new Set(counts).size, 9);
  assert.deepEqual(names, [
    "stable",
    "1 unstable root",
    "12 unstable roots",
    "65534 or more unstable roots",
    "no value",
    "lift-off",
  ]);
});

test("the legend tells what is in view", async () => {
  const page = await openPage(browser, server.link);
  const legend = () => page.locator("#legend > li").allInnerTexts();
  assert.deepEqual(await legend(), ["unstable roots", "0, stable", "2", "4", "6"]);
  await show(page, "#v=1&x=alpha_v,-0.5,-0.4&y=tau,3,3.5");
  assert.deepEqual(await legend(), ["unstable roots", "0, stable"]);
});

test("where a map has no v0, only the critical velocity is told", async () => {
  const page = await openPage(browser, server.link);
  await show(page, "#v=1&law=weakening");
  const seen = await page.evaluate(() => {
    const { panel } = window.slipmap;
    const { vc } = panel.next.texts;
    panel.look({ point: null, vc, motion: null }, { where: "γ = 1", start: null, fixed: true });
    const shown = (id) => document.getElementById(id).checkVisibility();
    const cards = ["sliding", "roots", "delays", "vc", "motion", "same"];
    return cards.filter((card) => shown(`${card}-card`));
  });
  assert.deepEqual(seen, ["vc", "same"]);
  assert.match(await words(page, "point-none"), /no v0/);
  assert.ok(await page.locator("#copy-command").isHidden());
  assert.match(await page.locator("#vc-command").inputValue(), /^slipmap vc /);
  assert.match(await page.locator("#vc-toml").inputValue(), /law = "weakening"/);
});
