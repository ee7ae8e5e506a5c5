// The page as it is worked with: what is in sight, what it offers, what is dropped onto it.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import {
  ROOT, atRest, chance, eventually, newFolder, openPage, opened, picture, placeOf, settled, show,
  slipmap, violations,
} from "./support.mjs";

const { browser, server } = await opened();

const asked = (args) => JSON.parse(slipmap([...args, "--json"]));
const LAW = "v=1&law=weakening&mu0=0.5&v_s=0.5&v0=0.35&at=-0.33,4.15";
const text = (page, id) => page.locator(`#${id}`).textContent();

async function set(page, name, value) {
  await page.locator(`#n-${name}`).fill(String(value));
  await atRest(page);
}

test("control, chart and all answers are in sight", async () => {
  for (const [width, height] of [[1440, 900], [1600, 1000]]) {
    const page = await openPage(browser, server.link, { width, height });
    await show(page, LAW);
    for (const id of ["p-v0", "chart", "point", "roots", "delays", "vc", "phase", "time"]) {
      const box = await page.locator(`#${id}`).boundingBox();
      assert.ok(box.y >= 0 && box.y + box.height <= height, `${width}: ${id} ${JSON.stringify(box)}`);
    }
    const [left, middle, right] = await Promise.all(
      ["live", "chart", "roots"].map((id) => page.locator(`#${id}`).boundingBox()),
    );
    assert.ok(left.x < middle.x && middle.x + middle.width < right.x);
    await picture(page, `workbench-${width}`);
    assert.deepEqual(page.faults, []);
  }
});

test("the answers follow the pointer, and come back", async () => {
  const page = await openPage(browser, server.link, { width: 1440 });
  await show(page, LAW);
  const { x, y } = await placeOf(page, [-0.6, 3.4]);
  await page.mouse.move(x - 20, y);
  await page.mouse.move(x, y, { steps: 4 });
  await eventually(async () => assert.match(await text(page, "point-title"), /pointer/));
  await eventually(async () => {
    const numbers = (await text(page, "point-where")).replaceAll("−", "-");
    const [gain, tau] = numbers.match(/-?[\d.]+(?=,|$)/g).map(Number);
    assert.ok(Math.abs(gain + 0.6) < 0.01 && Math.abs(tau - 3.4) < 0.05, numbers);
    const told = asked([
      "point", "--friction=weakening", "--mu0=0.5", "--v-s=0.5", "--v0=0.35",
      `--alpha-v=${gain}`, `--tau=${tau}`,
    ]);
    const shown = (await text(page, "point")).replaceAll("−", "-");
    assert.ok(shown.includes(Number(told.abscissa.toPrecision(6)).toString()), shown);
  });
  assert.match(await text(page, "hover"), /α_v = −0\.[56]/);
  assert.ok(await page.locator("#hover").isVisible());
  await page.mouse.move(2, 2);
  await eventually(async () => assert.match(await text(page, "point-title"), /At the point/));
  await eventually(async () => assert.match(await text(page, "point-where"), /−0\.33, τ = 4\.15/));
  assert.ok(!(await page.locator("#hover").isVisible()));
  assert.deepEqual(page.faults, []);
});

test("on a phone a slider and the answers stay at hand", async () => {
  const page = await openPage(browser, server.link, {
    width: 390, height: 844, hasTouch: true, isMobile: true,
  });
  await show(page, LAW);
  for (const top of [0, 500, 1500]) {
    await page.evaluate((to) => window.scrollTo(0, to), top);
    for (const id of ["p-v0", "sheet"]) {
      const box = await page.locator(`#${id}`).boundingBox();
      assert.ok(box.y >= 0 && box.y + box.height <= 844, `${top}: ${id} ${JSON.stringify(box)}`);
    }
  }
  assert.match(await text(page, "sheet"), /stable/);
  assert.ok(!(await page.locator("#roots").isVisible()));
  await page.locator("#sheet").tap();
  await page.locator("#roots").waitFor({ state: "visible" });
  assert.equal(await page.locator("#sheet").getAttribute("aria-expanded"), "true");
  assert.deepEqual(await violations(page), []);
  await page.locator("#sheet").tap();
  assert.ok(!(await page.locator("#roots").isVisible()));
  assert.deepEqual(page.faults, []);
});

test("every setting to begin with shows something stable, and back is back", async () => {
  const page = await openPage(browser, server.link);
  const before = await page.evaluate(() => location.hash);
  const presets = await page.locator("#preset option").count();
  assert.ok(presets > 4);
  for (let k = 1; k < presets; k++) {
    await page.locator("#preset").selectOption({ index: k });
    await settled(page);
    assert.equal(await text(page, "address-told"), "", `preset ${k}`);
    assert.ok(!(await page.locator("#nothing").isVisible()), `preset ${k}`);
    assert.match(await text(page, "readout"), /: stable/, `preset ${k}`);
  }
  await page.goBack();
  await settled(page);
  await page.locator("#undo").click();
  await settled(page);
  for (let k = 3; k < presets; k++) {
    await page.locator("#undo").click();
    await settled(page);
  }
  await eventually(async () => assert.equal(await page.evaluate(() => location.hash), before));
  assert.ok(await page.locator("#undo").isDisabled());
  assert.deepEqual(page.faults, []);
});

test("what was set is taken back and set again", async () => {
  const page = await openPage(browser, server.link);
  const slope = () => page.locator("#n-mu_prime").inputValue();
  await set(page, "mu_prime", -0.5);
  await page.waitForTimeout(1300);
  await set(page, "mu_prime", -0.7);
  await page.waitForTimeout(400);
  await page.locator("#undo").click();
  await eventually(async () => assert.equal(await slope(), "-0.5"));
  await page.locator("#chart").focus();
  await page.keyboard.press("Control+z");
  await eventually(async () => assert.equal(await slope(), "-0.3"));
  await page.locator("#redo").click();
  await eventually(async () => assert.equal(await slope(), "-0.5"));
  await atRest(page);
  // In a field the key is the field's own.
  await page.locator("#n-mu_prime").focus();
  await page.keyboard.press("Control+z");
  await page.waitForTimeout(300);
  assert.match(page.url(), /mu_prime=-0\.5/);
  assert.deepEqual(page.faults, []);
});

test("where nothing is stable, the stable region is found", async () => {
  const page = await openPage(browser, server.link);
  // A rig whose delays are milliseconds, in the ranges of a model without units.
  await show(
    page,
    "v=1&control=load&x=alpha_n,-8,1&y=tau,2,12&law=stribeck&units=N,m,s&mass=2&stiffness=500" +
      "&normal_load=30&v0=0.1&mu0=0.33&v_s=0.062&mu_s=0.52",
  );
  await page.locator("#nothing").waitFor();
  await page.locator("#where-stable").click();
  await eventually(async () => assert.ok(!(await page.locator("#nothing").isVisible())));
  await settled(page);
  assert.match(await text(page, "readout"), /: stable/);
  const [gain, tau] = await page.evaluate(() => window.slipmap.plane.point);
  const told = asked([
    "point", "--friction=stribeck", "--mass=2", "--stiffness=500", "--normal-load=30", "--v0=0.1",
    "--mu0=0.33", "--v-s=0.062", "--mu-s=0.52", `--alpha-n=${gain}`, `--tau=${tau}`,
  ]);
  assert.equal(told.n_unstable, 0);
  assert.ok(tau < 1, `${tau}`);
  assert.deepEqual(page.faults, []);
});

test("the best setting is marked, and taken", async () => {
  const page = await openPage(browser, server.link);
  await page.locator("#best").click();
  await page.getByRole("button", { name: "Take the best" }).waitFor();
  const ranges = ["--alpha-from=-1.6", "--alpha-to=0.4", "--tau-from=0", "--tau-to=12"];
  const { best, robust } = asked([
    "best", "--mu-prime=-0.3", "--control=velocity", "--robust=0.05", ...ranges,
  ]);
  const marked = await page.evaluate(() => window.slipmap.plane.best);
  assert.deepEqual(marked.point, [best.alpha, best.tau]);
  const box = [robust.alpha, robust.tau].map((x) => [0.95 * x, 1.05 * x]);
  for (const [i, ends] of box.entries()) {
    ends.forEach((end, k) => assert.ok(Math.abs(marked.box[i][k] - end) < 1e-9 * Math.abs(end)));
  }
  await picture(page, "best");
  await page.getByRole("button", { name: "Take the best" }).click();
  await settled(page);
  const taken = await page.evaluate(() => window.slipmap.state.point);
  assert.ok(Math.abs(taken[0] - best.alpha) < 1e-6 && Math.abs(taken[1] - best.tau) < 1e-6);
  // Of another setting it is not the best one.
  await set(page, "mu_prime", -0.4);
  assert.equal(await page.evaluate(() => window.slipmap.plane.best), null);
  assert.equal(await text(page, "best-told"), "");
  assert.deepEqual(page.faults, []);
});

test("two settings stand beside one another", async () => {
  const page = await openPage(browser, server.link);
  await show(page, LAW);
  const margin = async () =>
    page.evaluate(() => {
      const rows = [...document.querySelectorAll("#point > div")];
      return rows.find((row) => /delay margin/.test(row.innerText)).children[1].textContent;
    });
  const first = await margin();
  await page.locator("#compare").click();
  const { x, y } = await placeOf(page, [-0.6, 3.4]);
  await page.mouse.click(x, y);
  await page.mouse.move(2, 2);
  await settled(page);
  await eventually(async () => {
    const row = page.locator("#compared tr", { hasText: "delay margin" });
    assert.deepEqual(await row.locator("td").allTextContents(), [first, await margin()]);
    assert.notEqual(first, await margin());
  });
  assert.match(await page.locator("#compared thead").innerText(), /A: .*0\.33[^]*B: .*0\.6/);
  assert.deepEqual(await violations(page), []);
  // The address holds both, in another browser and for the way back.
  await eventually(() => assert.match(page.url(), /compare=/));
  const table = await page.locator("#compared").innerText();
  const other = await openPage(browser, server.link);
  const from = await other.evaluate(() => location.hash);
  await other.evaluate((hash) => (location.hash = hash), new URL(page.url()).hash);
  await eventually(async () => assert.equal(await other.locator("#compared").innerText(), table));
  const both = { at: [-0.33, 4.15], of: ["alpha_v", "tau"] };
  assert.deepEqual(await other.evaluate(() => window.slipmap.plane.other), both);
  await eventually(() => assert.equal(new URL(other.url()).hash, new URL(page.url()).hash));
  await other.reload();
  await eventually(async () => assert.equal(await other.locator("#compared").innerText(), table));
  // A preset is another setting beside the same one; back before it nothing was compared.
  await other.locator("#preset").selectOption({ index: 2 });
  await settled(other);
  assert.match(await other.locator("#compared thead").innerText(), /A: .*0\.33/);
  await other.evaluate((hash) => (location.hash = hash), from);
  await eventually(async () => assert.ok(!(await other.locator("#compared").isVisible())));
  // What is set meanwhile stays, and no map can be compared with.
  const hash = new URL(page.url()).hash;
  await other.evaluate((to) => {
    location.hash = to;
    setTimeout(() => {
      const slider = document.getElementById("p-v0");
      slider.value = "0.4";
      slider.dispatchEvent(new Event("input", { bubbles: true }));
    }, 20);
  }, hash);
  await eventually(() => assert.match(other.url(), /v0=0\.39/));
  await settled(other);
  assert.ok(!(await other.locator("#compared").isVisible()));
  await other.evaluate(() => (location.hash = "#v=1&compare=v%3D1%26map%3D0123456789abcdef"));
  await eventually(async () => assert.match(await text(other, "address-told"), /no setting of the live chart/));
  assert.deepEqual(other.faults, []);
  await other.context().close();
  await page.locator("#compare").click();
  assert.ok(!(await page.locator("#compared").isVisible()));
  await eventually(() => assert.doesNotMatch(page.url(), /compare=/));
  assert.deepEqual(page.faults, []);
});

test("a range the wrong way round is said beside it", async () => {
  const page = await openPage(browser, server.link);
  await page.locator("#axis-y-from").fill("20");
  await page.locator("#axis-y-from").press("Enter");
  const part = page.locator(".axis[data-axis=y]");
  assert.match(await part.locator(".mistake").textContent(), /from 20: from must be less than to; 0 stays/);
  assert.equal(await page.locator("#axis-y-from").inputValue(), "0");
  await page.locator("#axis-y-from").fill("2");
  await page.locator("#axis-y-from").press("Enter");
  await atRest(page);
  assert.equal(await part.locator(".mistake").textContent(), "");
});

test("what takes long says how long, and is stopped", async () => {
  const page = await openPage(browser, server.link);
  // A critical velocity of half a minute.
  await page.evaluate((hash) => (location.hash = hash), `${LAW.replace(/&at.*/, "")}&x=tau,850,1000&y=alpha_v,-0.6,0&at=900,-0.33`);
  const waiting = page.locator("#vc-waiting");
  await eventually(async () => assert.match(await waiting.textContent(), /computing for [1-9]/));
  await waiting.getByRole("button", { name: "Stop" }).click();
  await eventually(async () => assert.match(await waiting.textContent(), /stopped/));
  assert.match(await text(page, "vc"), /stopped/);
  await page.waitForTimeout(500);
  assert.match(await waiting.textContent(), /stopped/);
  await waiting.getByRole("button", { name: "Compute it" }).click();
  await eventually(async () => assert.match(await waiting.textContent(), /computing for [1-9]/));
  assert.deepEqual(page.faults, []);
  // Nobody waits for it any more.
  await page.close();
});

/** Drops a file with these bytes onto the page. */
async function drop(page, name, bytes) {
  await page.evaluate(
    ([as, all]) => {
      const dataTransfer = new DataTransfer();
      dataTransfer.items.add(new File([new Uint8Array(all)], as));
      for (const type of ["dragover", "drop"]) {
        document.body.dispatchEvent(
          new DragEvent(type, { bubbles: true, cancelable: true, dataTransfer }),
        );
      }
    },
    [name, [...bytes]],
  );
}

test("sweeps, cases and settings that are dropped are shown", async () => {
  const page = await openPage(browser, server.link);
  await drop(page, "fig2b.toml", readFileSync(join(ROOT, "sweeps/fig2b.toml")));
  await eventually(async () => assert.match(page.url(), /control=load&x=alpha_n,-8,1&y=tau,0,12/));
  await settled(page);
  assert.match(await text(page, "address-told"), /the axis mu_prime|^$/);
  await drop(page, "fig3a.toml", readFileSync(join(ROOT, "sweeps/fig3a.toml")));
  await eventually(async () => assert.match(page.url(), /law=weakening.*at=-0\.33,4\.15.*start=0\.3535,0/));
  await settled(page);
  const told = asked([
    "point", "--friction=weakening", "--mu0=0.5", "--v-s=0.5", "--v0=0.35", "--alpha-v=-0.33", "--tau=4.15",
  ]);
  const shown = (await text(page, "point")).replaceAll("−", "-");
  assert.ok(shown.includes(Number(told.abscissa.toPrecision(6)).toString()), shown);
  assert.ok(await page.locator("#undo").isEnabled());
  assert.deepEqual(page.faults, []);
});

test("from a measured curve to a marked best setting in five clicks", async () => {
  const page = await openPage(browser, server.link);
  const guide = readFileSync(join(ROOT, "doc/guide/rig.md"), "utf8");
  const [, curve] = guide.match(/```text file=belt\.csv\n([^]*?)```/);
  const kept = join(newFolder(), "belt.csv");
  writeFileSync(kept, curve);
  await drop(page, "belt.csv", Buffer.from(curve));
  // One: how it is controlled. Two: the units.
  await page.getByRole("radio", { name: "load" }).click();
  await page.locator("#units").selectOption("N,m,s");
  for (const [name, value] of [["mass", 2], ["stiffness", 500], ["normal_load", 30]]) {
    await page.locator(`#n-${name}`).fill(String(value));
  }
  await eventually(async () => assert.match(await text(page, "law-told"), /at v0 = 0\.\d+ m s-1/));
  // Three: where it is stable. Four: the best setting. Five: that one.
  await page.locator("#fit").click();
  await eventually(async () => assert.ok((await page.evaluate(() => window.slipmap.state.y.to)) < 2));
  await eventually(async () => assert.match(await text(page, "readout"), /: stable/));
  await page.locator("#best").click();
  await page.getByRole("button", { name: "Take the best" }).click({ timeout: 30000 });
  await settled(page);
  const [gain, tau] = await page.evaluate(() => window.slipmap.state.point);
  const v0 = await page.locator("#n-v0").inputValue();
  const text_ = await page.locator("#toml").inputValue();
  const setting = join(newFolder(), "setting.toml");
  writeFileSync(setting, text_);
  const told = asked(["point", "--setting", setting]);
  assert.equal(told.n_unstable, 0);
  assert.ok(Number(v0) > 0.005 && Number(v0) < 0.53, v0);
  const shown = (await text(page, "point")).replaceAll("−", "-");
  assert.ok(shown.includes(Number(told.abscissa.toPrecision(6)).toString()), `${gain}, ${tau}: ${shown}`);
  await picture(page, "five-clicks");
  assert.deepEqual(page.faults.filter((fault) => !/status of 422/.test(fault)), []);
});

test("a map that is dropped is shown as from a folder, and is in no list", async () => {
  const [sweep, map] = [join(newFolder(), "own.toml"), join(newFolder(), "own.h5")];
  writeFileSync(sweep, "[axes]\nalpha_v = { from = -1.6, to = 0.4, points = 40 }\n" +
    "tau = { from = 0.0, to = 12.0, points = 30 }\n[fixed]\nmu_prime = -0.3\n");
  slipmap(["run", sweep, "-o", map]);
  const page = await openPage(browser, server.link);
  await drop(page, "own.h5", readFileSync(map));
  await eventually(async () => assert.match(await text(page, "map-title"), /own\.h5/));
  await atRest(page);
  await eventually(async () => assert.match(page.url(), /map=[0-9a-f]{16}/));
  assert.equal(await page.locator("#maps").getByText("own.h5").count(), 0);
  assert.match(await text(page, "readout"), /stable|unstable/);
  assert.deepEqual(page.faults, []);
});

test("whatever is dropped leads to words, and the page goes on", async () => {
  const page = await openPage(browser, server.link);
  const big = join(newFolder(), "big.csv");
  execFileSync("truncate", ["-s", "1G", big]);
  await page.locator("#file").setInputFiles(big);
  await eventually(async () => assert.match(await text(page, "problem"), /big\.csv: 1073741824 bytes; at most/));
  await drop(page, "names.toml", Buffer.from('[axes]\ntau = [1, 2]\n[friction]\nlaw = "table"\ntable = "/etc/passwd"\n'));
  await eventually(async () => assert.match(await text(page, "problem"), /names\.toml: .*(file|table)/));
  await drop(page, "map.h5", Buffer.from("\x89HDF\r\n\x1a\n"));
  await eventually(async () => assert.match(await text(page, "problem"), /map\.h5: the map cannot be read/));
  const sound = readFileSync(join(ROOT, "sweeps/fig3a.toml"));
  const numbers = chance(7);
  for (let k = 0; k < 200; k++) {
    const bytes = Buffer.from(sound);
    const kind = k % 4;
    if (kind === 0) bytes[Math.floor(numbers.next().value * bytes.length)] ^= 1 << Math.floor(numbers.next().value * 8);
    else if (kind === 1) bytes.fill(Math.floor(numbers.next().value * 256), 100, 100 + k);
    const cut = kind === 2 ? bytes.subarray(0, Math.floor(numbers.next().value * bytes.length)) : bytes;
    await page.evaluate(() => (document.getElementById("problem").textContent = ""));
    await drop(page, kind === 3 ? `odd${k}.csv` : `odd${k}.toml`, cut);
    await page.waitForTimeout(20);
  }
  await show(page, LAW);
  assert.match(await text(page, "readout"), /stable/);
  const unexpected = page.faults.filter((fault) => !/status of 4\d\d/.test(fault));
  assert.deepEqual(unexpected, []);
});
