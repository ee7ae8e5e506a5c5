// The page while the server takes its time: what is not up to date says so, and what nobody waits
// for any more is not computed.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { atRest, eventually, openPage, opened, settled, show, violations } from "./support.mjs";

const { browser, server } = await opened();

const LAW = "law=weakening";
const FORMER = /of the former values/;

async function set(page, name, value) {
  await page.locator(`#p-${name}`).evaluate((slider, to) => {
    const input = slider.parentElement.querySelector("input[type=number]");
    input.value = to;
    input.dispatchEvent(new Event("input"));
  }, value);
}

/** Answers to a kind of request come later by so many milliseconds; ends with what is returned. */
async function delayed(page, what, time) {
  const late = async (route) => {
    await new Promise((done) => setTimeout(done, time));
    await route.continue().catch(() => {});
  };
  await page.route(`**/api/v1/${what}`, late);
  return () => page.unroute(`**/api/v1/${what}`);
}

const told = (page, id) => page.locator(`#${id}`).textContent();
const dimmed = (page) =>
  page.evaluate(() => Number(getComputedStyle(document.getElementById("chart")).opacity) < 1);

test("a chart of former values says so until the new one is there", async () => {
  const page = await openPage(browser, server.link);
  assert.equal(await told(page, "stale"), "");
  const end = await delayed(page, "chart", 1500);
  await set(page, "mu_prime", -0.6);
  await eventually(async () => assert.match(await told(page, "stale"), FORMER));
  assert.equal(await page.locator("#stale").getAttribute("role"), "status");
  assert.ok(await dimmed(page));
  assert.deepEqual(await violations(page), []);
  await end();
  await atRest(page);
  assert.equal(await told(page, "stale"), "");
  assert.ok(!(await dimmed(page)));
  // Nor does it pass for what was refused.
  await page.route("**/api/v1/chart", (route) =>
    route.fulfill({ status: 503, contentType: "application/problem+json", body: "{}" }),
  );
  await set(page, "mu_prime", -0.5);
  await eventually(async () => assert.match(await told(page, "stale"), FORMER));
  await page.unroute("**/api/v1/chart");
  await set(page, "mu_prime", -0.4);
  await atRest(page);
  assert.equal(await told(page, "stale"), "");
});

test("so do the cards of a point and the motion from a start", async () => {
  const page = await openPage(browser, server.link);
  await show(page, `v=1&${LAW}`);
  assert.equal(await told(page, "point-stale"), "");
  const end = await delayed(page, "point", 1500);
  await set(page, "mass", 1.5);
  await eventually(async () => assert.match(await told(page, "point-stale"), /the point before/));
  await end();
  await settled(page);
  await eventually(async () => assert.equal(await told(page, "point-stale"), ""));
  const later = await delayed(page, "motion", 1500);
  await page.locator("#start-u").fill("0.11");
  await page.locator("#start-u").press("Enter");
  await eventually(async () => assert.match(await told(page, "motion-stale"), /the start before/));
  await later();
  await settled(page);
  await eventually(async () => assert.equal(await told(page, "motion-stale"), ""));
});

test("a slow chart is given up for a newer one", async () => {
  const page = await openPage(browser, server.link);
  const aborted = [];
  page.on("requestfailed", (request) => aborted.push(request.url()));
  const end = await delayed(page, "chart", 60_000);
  // Each is asked for by itself, and for good once nothing moves.
  for (const slope of [-0.6, -0.55]) {
    await set(page, "mu_prime", slope);
    await page.waitForTimeout(250);
  }
  await end();
  await atRest(page);
  assert.ok(aborted.length >= 1 && aborted.every((url) => url.endsWith("/chart")), `${aborted}`);
  const slope = Number(await page.locator("#p-mu_prime").inputValue());
  assert.ok(Math.abs(slope + 0.55) < 0.01, `${slope}`);
});

/** The time that the server has taken, in seconds; no other system than Linux says it so. */
function cpu() {
  const words = readFileSync(`/proc/${server.child.pid}/stat`, "utf8").split(") ").pop();
  const [user, system] = words.split(" ").slice(11, 13).map(Number);
  return (user + system) / 100;
}

const linux = process.platform === "linux" ? false : "reads /proc";

test("a critical velocity that is superseded takes no time of the server", { skip: linux }, async () => {
  const page = await openPage(browser, server.link);
  const slow = "x=tau,850,1000&y=alpha_v,-0.6,0&at=900,-0.33";
  await show(page, `v=1&${LAW}`);
  const waiting = page.waitForRequest("**/api/v1/vc");
  await page.evaluate((hash) => (location.hash = hash), `v=1&${LAW}&${slow}`);
  await waiting;
  const begun = cpu();
  await eventually(() => assert.ok(cpu() > begun + 0.1, "it is computed"));
  await show(page, `v=1&${LAW}`);
  // Half a second in which it is idle: what else the page asks for comes to an end at some time,
  // while a critical velocity here takes a processor for far longer than is waited for.
  await eventually(async () => {
    const before = cpu();
    await page.waitForTimeout(500);
    const taken = cpu() - before;
    assert.ok(taken < 0.05, `${taken} s`);
  });
});
