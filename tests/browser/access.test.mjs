// The page for those who see it small, dark, through a reader of the screen, or by keyboard alone.

import assert from "node:assert/strict";
import { test } from "node:test";
import { atRest, openPage, opened, picture, settled, violations } from "./support.mjs";

const { browser, server } = await opened();

for (const width of [390, 1024, 1600]) {
  for (const colorScheme of ["light", "dark"]) {
    test(`${width} px, ${colorScheme}: no violations, nothing cut off`, async () => {
      const page = await openPage(browser, server.link, {
        width,
        height: 900,
        colorScheme,
        reducedMotion: "reduce",
      });
      await page.locator("#law").selectOption("weakening");
      await page.evaluate(() =>
        document.querySelectorAll("details").forEach((part) => (part.open = true)),
      );
      await atRest(page);
      await page.waitForFunction(
        () => window.slipmap.panel.motion.motion && window.slipmap.panel.point,
      );
      await page.waitForTimeout(400);
      await picture(page, `live-${width}-${colorScheme}`);
      assert.deepEqual(await violations(page), []);
      const over = await page.evaluate(
        () => document.documentElement.scrollWidth - window.innerWidth,
      );
      assert.ok(over <= 0, `${over} px too wide`);
      assert.deepEqual(page.faults, []);
    });
  }
}

test("every control has a name, and focus is seen", async () => {
  const page = await openPage(browser, server.link);
  const names = new Set();
  for (let k = 0; k < 80; k++) {
    await page.keyboard.press("Tab");
    const at = await page.evaluate(() => {
      const on = document.activeElement;
      if (on === document.body) return null;
      const style = getComputedStyle(on);
      return { tag: on.tagName, id: on.id, outline: style.outlineStyle, width: style.outlineWidth };
    });
    if (!at) break;
    assert.ok(at.outline !== "none" && at.width !== "0px", `${at.tag} ${at.id} shows its focus`);
    names.add(`${at.tag} ${at.id}`);
  }
  for (const id of ["CANVAS chart", "INPUT p-mu_prime", "SELECT law", "BUTTON save-csv"]) {
    assert.ok(names.has(id), `${id} among ${[...names].join(", ")}`);
  }
});

test("a key in the form leaves the focus where it is", async () => {
  const page = await openPage(browser, server.link);
  const focus = () => page.evaluate(() => document.activeElement.id);
  const press = async (id, key) => {
    await page.locator(`#${id}`).focus();
    await page.keyboard.press(key);
    await page.waitForTimeout(50);
    assert.equal(await focus(), id);
  };
  await press("axis-x", "ArrowDown");
  await press("axis-x", "ArrowDown");
  assert.notEqual(await page.locator("#axis-x").inputValue(), "alpha_v");
  await press("axis-y-log", "Space");
  await press("law", "ArrowDown");
  await press("law", "ArrowUp");
  await settled(page);
  await page.locator("#take-law").focus();
  await page.keyboard.press("Enter");
  assert.equal(await focus(), "motion-title");
});

test("a table tells what the chart shows", async () => {
  const page = await openPage(browser, server.link);
  await page.getByText("The same as a table").click();
  await page.waitForTimeout(400);
  const rows = await page.locator("#table tbody tr").count();
  assert.equal(rows, 9);
  const cells = await page.locator("#table tbody td").allInnerTexts();
  assert.ok(cells.includes("2 unstable roots") && cells.includes("4 unstable roots"), cells.join(", "));
});

test("two fingers zoom on a small screen, one scrolls the page", async () => {
  const page = await openPage(browser, server.link, {
    width: 390,
    height: 844,
    hasTouch: true,
    isMobile: true,
  });
  assert.equal(
    await page.locator("#chart").evaluate((chart) => getComputedStyle(chart).touchAction),
    "pan-y",
  );
  const box = await page.locator("#chart").boundingBox();
  const session = await page.context().newCDPSession(page);
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  const touch = (type, apart) =>
    session.send("Input.dispatchTouchEvent", {
      type,
      touchPoints:
        type === "touchEnd"
          ? []
          : [
              { x: x - apart, y, id: 0 },
              { x: x + apart, y, id: 1 },
            ],
    });
  const width = () =>
    page.evaluate(() => window.slipmap.plane.view[0].to - window.slipmap.plane.view[0].from);
  const before_ = await width();
  await touch("touchStart", 30);
  for (const apart of [40, 50, 60]) await touch("touchMove", apart);
  await touch("touchEnd", 0);
  await atRest(page);
  assert.ok((await width()) < 0.7 * before_, `${await width()} after ${before_}`);
});
