// The queue in a real browser: a sweep is written, handed in, computed by a worker, and looked at.

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { readdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import {
  PROGRAM,
  atRest,
  eventually,
  newFolder,
  openBrowser,
  openPage,
  picture,
  serve,
  slipmap,
  violations,
} from "./support.mjs";

const browser = await openBrowser();
test.after(() => browser.close());

const SMALL = `[axes]
alpha_v = { from = -1.6, to = 0.4, points = 40 }
tau = { from = 0.0, to = 12.0, points = 30 }
[fixed]
mu_prime = -0.3
`;
const WRONG = SMALL.replace("alpha_v = { from", "alpha_w = { from");
/** It takes longer than a test waits, and is saved tile by tile. */
const LONG = `fields = ["vc", "outcome"]
[axes]
alpha_n = { from = -3.0, to = 1.0, points = 600 }
tau = { from = 0.3, to = 5.0, points = 600 }
[friction]
law = "weakening"
mu0 = 0.5
v_s = 0.5
`;

/** A server that takes sweeps, in a folder of its own. */
async function opened(test_, folder = newFolder(), port = 0) {
  const server = await serve([folder, "--submit", "--keep-free", "0B"], port);
  test_.after(() => server.end());
  return { server, folder };
}

/** A worker, until it is ended. */
function work(test_, folder, args = []) {
  const child = spawn(PROGRAM, ["work", folder, "--threads", "1", ...args], { stdio: "ignore" });
  const ended = new Promise((done) => child.once("exit", done));
  const end = async () => {
    child.kill("SIGTERM");
    await ended;
  };
  test_.after(end);
  return { end, ended };
}

async function openQueue(link, options) {
  const page = await openPage(browser, link, options);
  await page.getByRole("button", { name: /^Queue/ }).click();
  return page;
}

const job = (page, name) => page.locator(`[data-job$="-${name}"]`);
const nameOf = (page, name) => job(page, name).getAttribute("data-job");
const state = (page, name, wanted, timeout = 30000) =>
  job(page, name).and(page.locator(`.${wanted}`)).waitFor({ timeout });
const act = (page, name, label) =>
  job(page, name)
    .getByRole("button", { name: new RegExp(`^${label} `) })
    .click();
const onFocus = (page) =>
  page.evaluate(() => {
    const on = document.activeElement;
    if (on === document.body) return "";
    return `${on.closest("[data-job]")?.dataset.job ?? ""} ${on.id || on.textContent}`.trim();
  });

/** Waits for an answer of the editor about what is in it. */
const planned = (page) =>
  page.waitForFunction(() => {
    const { editor } = window.slipmap.queue;
    const { text, answer, error } = editor.plans;
    return text === editor.text.value && (answer || error);
  });

const timed = (page) => page.getByText("its map takes about").waitFor({ timeout: 30000 });

async function handIn(page, text, title) {
  await page.locator("#sweep-text").fill(text);
  await page.locator("#sweep-name").fill(title);
  await page.getByRole("button", { name: "Submit" }).click();
  await job(page, title).waitFor();
}

test("a mistake is told at its place, mended, planned, and handed in", async (t) => {
  const { server, folder } = await opened(t);
  const page = await openQueue(server.link);
  const asked = [];
  page.on("request", (request) => asked.push(request.url()));
  await page.getByText("No worker is there").waitFor();
  assert.equal(await page.locator("#work-command").innerText(), `slipmap work ${folder}`);
  const text = page.locator("#sweep-text");
  await text.fill("");
  await text.pressSequentially(WRONG.slice(0, 60));
  const plans = () => asked.filter((url) => url.includes("/plan")).length;
  await eventually(async () => assert.ok(plans() > 0));
  assert.ok(plans() < 12, `${plans()} questions for 60 keys`);
  await text.fill(WRONG);
  const mistake = page.locator("#sweep-mistake");
  await mistake.getByText("line 2, column 1: ").waitFor();
  assert.match(await mistake.innerText(), /alpha_w/);
  assert.match(await page.locator("#sweep-help").innerText(), /alpha_v/);
  assert.equal(await text.getAttribute("aria-invalid"), "true");
  const described = await text.getAttribute("aria-describedby");
  assert.ok(described.split(" ").includes("sweep-mistake"));
  assert.equal(await page.locator("#sweep-marks mark").innerText(), "alpha_w");
  const [mark, shown] = await page.evaluate(() => {
    const [first, second] = ["#sweep-marks mark", "#sweep-text"].map((of) =>
      document.querySelector(of).getBoundingClientRect(),
    );
    return [first.top - second.top, first.height];
  });
  assert.ok(mark > shown / 2 && mark < 3 * shown, `the mark is at the second line: ${mark}`);
  await page.getByRole("button", { name: "To line 2" }).click();
  const chosen = () =>
    text.evaluate((area) => area.value.slice(area.selectionStart, area.selectionEnd));
  assert.equal(await chosen(), "alpha_w");
  await picture(page, "queue-mistake");
  assert.deepEqual(await violations(page), []);
  // What cannot be handed in is told at its place, too.
  await page.getByRole("button", { name: "Submit" }).click();
  await eventually(async () => assert.equal(await onFocus(page), "sweep-text"));
  await page.keyboard.press("Control+Home");
  await text.fill(SMALL);
  await planned(page);
  assert.equal(await text.getAttribute("aria-invalid"), "false");
  assert.equal(await mistake.innerText(), "");
  const plan = await page.locator("#plan").innerText();
  assert.match(plan, /1,200/);
  assert.match(plan, /memory/);
  assert.match(plan, /are free/);
  await page.getByRole("button", { name: "How long?" }).click();
  await timed(page);
  await page.locator("#sweep-name").fill("First of all");
  await page.reload();
  await atRest(page);
  await page.getByRole("button", { name: /^Queue/ }).click();
  assert.equal(await text.inputValue(), SMALL);
  assert.equal(await page.locator("#sweep-name").inputValue(), "First of all");
  await planned(page);
  await page.getByRole("button", { name: "Submit" }).click();
  await page.locator("#queue-told", { hasText: "Handed in as" }).waitFor();
  const said = await page.locator("#queue-told").innerText();
  assert.match(said, /Handed in as \d{6}-\S+; it waits, the next\./);
  const [, name] = said.match(/as (\S+);/);
  await eventually(async () => assert.equal(await onFocus(page), `${name} ${name}`));
  const { jobs } = JSON.parse(slipmap(["jobs", folder, "--json"]));
  assert.deepEqual(jobs.map((one) => [one.name, one.state]), [[name, "waiting"]]);
  await page.getByRole("button", { name: "Submit" }).click();
  await page.locator("#queue-told", { hasText: "is there already" }).waitFor();
  await page.reload();
  await page.getByRole("button", { name: /^Queue/ }).click();
  assert.equal(await text.inputValue(), "", "what was handed in is not kept");
  const other = page.faults.filter((fault) => !/422/.test(fault));
  assert.deepEqual(other, []);
});

test("sweeps are held, released, put first and dropped, by keyboard too", async (t) => {
  const { server, folder } = await opened(t);
  const page = await openQueue(server.link);
  for (const [k, title] of ["one", "two", "three"].entries()) {
    await handIn(page, SMALL.replace("-0.3", `-0.3${k}`), title);
  }
  const order = () =>
    page.locator("#jobs > li").evaluateAll((items) => items.map((item) => item.dataset.job));
  await act(page, "two", "Hold");
  await state(page, "two", "held");
  const two = await nameOf(page, "two");
  await eventually(async () => assert.equal(await onFocus(page), `${two} Release`));
  await page.keyboard.press("Enter");
  await state(page, "two", "waiting");
  await eventually(async () => assert.equal(await onFocus(page), `${two} Hold`));
  await act(page, "three", "First");
  await page.locator("#queue-told", { hasText: "is the next, as" }).waitFor();
  await eventually(async () => assert.match((await order())[0], /-three$/));
  const three = await nameOf(page, "three");
  await eventually(async () => assert.equal(await onFocus(page), `${three} ${three}`));
  await act(page, "two", "Drop");
  assert.equal(await onFocus(page), `${two} Keep it`);
  await page.keyboard.press("Escape");
  assert.equal(await onFocus(page), `${two} Drop`);
  await act(page, "two", "Drop");
  await act(page, "two", "Drop it");
  await job(page, "two").waitFor({ state: "detached" });
  await eventually(async () => assert.match(await onFocus(page), /-(one|three) /));
  assert.equal(JSON.parse(slipmap(["jobs", folder, "--json"])).jobs.length, 2);
  await page.locator("#sweep-hold").check();
  await handIn(page, SMALL.replace("-0.3", "-0.4"), "later");
  await state(page, "later", "held");
  await page.locator("#sweep-first").check();
  await handIn(page, SMALL.replace("-0.3", "-0.5"), "now");
  await eventually(async () => assert.match((await order())[0], /-now$/));
  // Others change the queue, too.
  slipmap(["jobs", "hold", await nameOf(page, "one"), "--in", folder]);
  await state(page, "one", "held");
  assert.deepEqual(page.faults, []);
});

test("a worker computes it: progress, held, released, done, its map", async (t) => {
  const { server, folder } = await opened(t);
  const page = await openQueue(server.link);
  await handIn(page, LONG, "long");
  await handIn(page, SMALL, "small");
  work(t, folder);
  await state(page, "long", "running");
  await page.locator("#queue-unattended").waitFor({ state: "hidden" });
  // What is computed is saved every few seconds.
  const bar = job(page, "long").locator("progress");
  await page.waitForFunction(
    () => document.querySelector("#jobs progress:not([hidden])")?.value > 0,
    undefined,
    { timeout: 90000 },
  );
  assert.equal(await bar.getAttribute("max"), "360000");
  assert.match(await job(page, "long").innerText(), /% of 360,000 cells/);
  await job(page, "long").locator("summary", { hasText: "Log" }).click();
  await job(page, "long").locator("pre", { hasText: '"' }).waitFor();
  await picture(page, "queue-running");
  await job(page, "long").locator("h3 button").click();
  await page.waitForFunction(() => window.slipmap.saved.map?.state === "running");
  assert.equal(await onFocus(page), "chart-title");
  await page.getByRole("button", { name: /^Queue/ }).click();
  await act(page, "long", "Hold");
  await state(page, "long", "held");
  await state(page, "small", "done", 60000);
  await act(page, "long", "Release");
  await state(page, "long", "running");
  await act(page, "long", "Hold");
  await act(page, "long", "Drop");
  await page.getByText("and what is computed of its map").click();
  // Its run may have to end first.
  await eventually(async () => {
    await act(page, "long", "Drop it");
    await job(page, "long").waitFor({ state: "detached", timeout: 1000 });
  });
  assert.deepEqual(readdirSync(folder).filter((file) => file.includes("long.h5.tiles")), []);
  await job(page, "small").locator("h3 button").click();
  await page.waitForFunction(() => window.slipmap.saved.map?.state === "complete");
  await atRest(page);
  assert.equal(await page.locator("#origin").innerText(), "from the file");
  assert.ok(await page.locator("#queue").isHidden());
  const others = page.faults.filter((fault) => !/409 \(Conflict\)/.test(fault));
  assert.deepEqual(others, []);
});

test("what fails says why, and notices come only when asked for", async (t) => {
  const { server, folder } = await opened(t);
  const page = await openPage(browser, null);
  await page.addInitScript(() => {
    window.notices = [];
    window.Notification = class {
      static requestPermission() {
        window.notices.push("asked");
        return Promise.resolve("granted");
      }
      constructor(title) {
        window.notices.push(title);
      }
    };
  });
  await page.goto(server.link);
  await page.getByRole("button", { name: /^Queue/ }).click();
  const notices = () => page.evaluate(() => window.notices);
  await handIn(page, SMALL, "quiet");
  const first = work(t, folder);
  await state(page, "quiet", "done", 60000);
  await first.end();
  assert.deepEqual(await notices(), []);
  const button = page.getByRole("button", { name: "Tell me when one is done" });
  await button.click();
  await eventually(async () => assert.equal(await button.getAttribute("aria-pressed"), "true"));
  await handIn(page, SMALL.replace("-0.3", "-0.35"), "loud");
  const name = await nameOf(page, "loud");
  work(t, folder);
  await state(page, "loud", "done", 60000);
  assert.deepEqual(await notices(), ["asked", `${name} is done`]);
  await page.locator("#queue-told", { hasText: `${name} is done.` }).waitFor();
  assert.deepEqual(page.faults, []);
});

test("why one failed: the first line, and the rest on demand", async (t) => {
  const { server } = await opened(t);
  const page = await openPage(browser, null);
  const failed = {
    name: "100010-broken",
    state: "failed",
    place: null,
    map: "100010-broken.h5",
    map_id: null,
    cells: null,
    cells_done: null,
    cells_per_second: null,
    seconds_left: null,
    host: null,
    tries: 3,
    why: "  × the run was killed\n3 tries with",
    shards: [],
  };
  await page.route("**/api/v1/jobs", (route) =>
    route.fulfill({ json: { attended: true, may_change: true, jobs: [failed] } }),
  );
  const why = "  × the run was killed\n3 tries without progress\n\nthe end of its log:\nlast";
  await page.route("**/api/v1/jobs/100010-broken", (route) =>
    route.fulfill({ json: { ...failed, why, log: "first\nlast\n" } }),
  );
  await page.goto(server.link);
  await page.getByRole("button", { name: /^Queue/ }).click();
  const row = job(page, "broken");
  assert.equal(await row.locator("summary").innerText(), "the run was killed");
  assert.ok(await row.locator("pre").isHidden());
  await row.locator("summary").click();
  await row.getByText("3 tries without progress").waitFor();
  assert.doesNotMatch(await row.locator("pre").innerText(), /first/);
  await row.getByRole("button", { name: /^Release/ }).waitFor();
  assert.deepEqual(await violations(page), []);
});

test("the link for those who look has no buttons, and the server refuses", async (t) => {
  const { server, folder } = await opened(t);
  const page = await openQueue(server.link);
  await handIn(page, SMALL, "seen");
  const looking = await openQueue(server.look);
  await job(looking, "seen").waitFor();
  assert.equal(await looking.locator("#jobs button").count(), 0);
  assert.ok(await looking.locator("#sweep").isHidden());
  assert.ok(await looking.locator("#overnight").isHidden());
  const name = await nameOf(looking, "seen");
  const statuses = await looking.evaluate(async (of) => {
    const headers = (kind) => ({ "Content-Type": `application/${kind}` });
    const ask = async (path, options) => (await fetch(`api/v1/jobs${path}`, options)).status;
    return [
      await ask("", { method: "POST", headers: headers("toml"), body: "[axes]\ntau = [1]" }),
      await ask(`/${of}`, { method: "PATCH", headers: headers("json"), body: '{"state":"held"}' }),
      await ask(`/${of}`, { method: "DELETE" }),
    ];
  }, name);
  assert.deepEqual(statuses, [403, 403, 403]);
  assert.equal(JSON.parse(slipmap(["jobs", folder, "--json"])).jobs[0].state, "waiting");
  await picture(looking, "queue-look");
  assert.deepEqual(await violations(looking), []);
});

test("a server that takes no sweeps has no queue on its page", async (t) => {
  const server = await serve([newFolder()]);
  t.after(() => server.end());
  const page = await openPage(browser, server.link);
  await page.waitForFunction(() => window.slipmap.queue.listed);
  assert.ok(await page.getByRole("button", { name: /^Queue/ }).isHidden());
  assert.ok(await page.locator("#overnight").isHidden());
  assert.deepEqual(page.faults, []);
});

test("the chart is run overnight, and a text that was there is taken back", async (t) => {
  const { server } = await opened(t);
  const page = await openQueue(server.link);
  await page.locator("#sweep-text").fill(SMALL);
  await planned(page);
  await page.getByRole("button", { name: "Run this overnight" }).click();
  const own = await page.evaluate(() => window.slipmap.live.text(window.slipmap.state));
  assert.equal(await page.locator("#sweep-text").inputValue(), own);
  assert.equal(await onFocus(page), "sweep-name");
  await planned(page);
  assert.match(await page.locator("#plan").innerText(), /480,000/);
  await page.getByRole("button", { name: "Take back the text before" }).click();
  assert.equal(await page.locator("#sweep-text").inputValue(), SMALL);
  await page.getByRole("button", { name: "Run this overnight" }).click();
  await page.getByRole("button", { name: "Submit" }).click();
  await job(page, "n-unstable-over-alpha-v-and-tau").waitFor();
  assert.deepEqual(page.faults, []);
});

test("the page goes on when the server is back, with its text", async (t) => {
  const { server, folder } = await opened(t);
  const page = await openQueue(server.link);
  await handIn(page, SMALL, "kept");
  await page.locator("#sweep-text").fill(`${SMALL}# not yet\n`);
  server.child.kill("SIGKILL");
  await page.getByText("The server does not answer").waitFor();
  const { server: anew } = await opened(t, folder, server.port);
  await page.getByText("The server was started anew").waitFor();
  const other = await page.context().newPage();
  await other.goto(anew.link);
  await other.close();
  await page.locator("#gone").waitFor({ state: "hidden" });
  assert.equal(await page.locator("#sweep-text").inputValue(), `${SMALL}# not yet\n`);
  await planned(page);
  await act(page, "kept", "Hold");
  await state(page, "kept", "held");
  // The stream is there again.
  slipmap(["jobs", "release", await nameOf(page, "kept"), "--in", folder]);
  await state(page, "kept", "waiting");
});

test("one stream a tab, which is closed while the page is hidden", async (t) => {
  const { server, folder } = await opened(t);
  const page = await openPage(browser, null);
  const streams = [];
  page.on("request", (request) => request.url().endsWith("/events") && streams.push(request));
  await page.goto(server.link);
  await page.getByRole("button", { name: /^Queue/ }).click();
  const stream = () => page.evaluate(() => window.slipmap.queue.changes.stream?.readyState ?? null);
  await eventually(async () => assert.equal(await stream(), 1));
  const see = (seen) =>
    page.evaluate((visible) => {
      const value = visible ? "visible" : "hidden";
      Object.defineProperty(document, "visibilityState", { value, configurable: true });
      document.dispatchEvent(new Event("visibilitychange"));
    }, seen);
  await see(false);
  assert.equal(await stream(), null);
  await eventually(async () => assert.ok(streams[0].failure(), "it is closed"));
  const sweep = join(newFolder(), "hidden.toml");
  writeFileSync(sweep, SMALL);
  slipmap(["submit", sweep, "--to", folder]);
  await page.waitForTimeout(1500);
  assert.equal(await job(page, "hidden").count(), 0);
  await see(true);
  await job(page, "hidden").waitFor();
  assert.equal(streams.length, 2);
  assert.deepEqual(page.faults, []);
});

for (const [width, height] of [
  [1440, 900],
  [390, 844],
]) {
  for (const colorScheme of ["light", "dark"]) {
    test(`the queue at ${width} px, ${colorScheme}: no violations, nothing cut off`, async (t) => {
      const { server } = await opened(t);
      const page = await openQueue(server.link, { width, height, colorScheme });
      await handIn(page, SMALL, "a-title-of-a-sweep-that-is-long-enough-to-be-broken-on-a-phone");
      await handIn(page, SMALL.replace("-0.3", "-0.4"), "held");
      await act(page, "held", "Hold");
      await state(page, "held", "held");
      await page.locator("#sweep-text").fill(SMALL);
      await planned(page);
      await page.getByRole("button", { name: "How long?" }).click();
      await timed(page);
      await picture(page, `queue-${width}-${colorScheme}`);
      assert.deepEqual(await violations(page), []);
      await page.locator("#sweep-text").fill(WRONG);
      await page.locator("#sweep-mistake", { hasText: "line 2" }).waitFor();
      await act(page, "held", "Drop");
      await picture(page, `queue-mistake-${width}-${colorScheme}`);
      assert.deepEqual(await violations(page), []);
      const over = await page.evaluate(
        () => document.documentElement.scrollWidth - window.innerWidth,
      );
      assert.ok(over <= 0, `${over} px too wide`);
    });
  }
}
