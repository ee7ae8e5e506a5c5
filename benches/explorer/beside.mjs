// Charts while critical velocities are computed: how long each takes from request to answer, and
// how they follow one another while a slider moves.

import { atRest } from "../support.mjs";
import { dragged } from "./live.mjs";
import { median, quantile, share, time } from "./measures.mjs";

/** Charts that are asked for in turn, and critical velocities that are waited for meanwhile. */
const [CHARTS, SLOW] = [50, 4];
/** How often a slider moves beside a critical velocity and without one, and for how many seconds. */
const [DRAGS, SECONDS] = [5, 3];

/** Asks for critical velocities of half a minute each, until `wait` is over; how many are pending then. */
const beside = async (page, count, wait) => {
  await page.evaluate(async (number) => {
    const law = '[friction]\nlaw = "weakening"\nmu0 = 0.5\nv_s = 0.5\n';
    const leaving = new AbortController();
    const slow = { leaving, left: number };
    for (let n = 0; n < number; n++) {
      const text = `[fixed]\nalpha_v = -0.33\ntau = ${900 + n}\n${law}`;
      const done = () => (slow.left -= 1);
      window.slipmap.source.vc(text, leaving.signal).then(done, done);
    }
    window.slow = slow;
    await new Promise((done) => setTimeout(done, 300));
  }, count);
  const came = await wait();
  const pending = await page.evaluate(() => {
    // One that is done by now was none to wait for.
    const { left, leaving } = window.slow;
    leaving.abort();
    return left;
  });
  return { came, pending };
};

/** Asks for charts in turn. */
const charts = async (count) => {
  const { live, source, state } = window.slipmap;
  const text = live.text(state, [200, 150], ["n_unstable"]);
  const took = [];
  for (let n = 0; n < count; n++) {
    const begun = performance.now();
    await source.chart(text);
    took.push(performance.now() - begun);
  }
  return took;
};

const titled = (count, pending) =>
  count ? `beside ${count} vc (${pending} still pending)` : "alone";

/** Rows of a table: charts alone, and beside critical velocities. */
export async function rowsOfBeside(page) {
  await atRest(page);
  const rows = [["slipmap, charts of 200 × 150 cells in turn, from request to answer"]];
  for (const searches of [0, SLOW]) {
    const wait = () => page.evaluate(charts, CHARTS);
    const { came: took, pending } = await beside(page, searches, wait);
    const title = titled(searches, pending);
    rows.push([`${title}, median`, time(quantile(took, 0.5))]);
    rows.push([`${title}, 95 %`, time(quantile(took, 0.95))]);
  }
  return [...rows, ...await rowsOfDrags(page)];
}

/** Rows of a table: from chart to chart while a slider moves, in turn alone and beside. */
async function rowsOfDrags(page) {
  const all = new Map([[0, []], [1, []]]);
  for (let turn = 0; turn < DRAGS; turn++) {
    for (const [searches, list] of all) {
      const { came, pending } = await beside(page, searches, () => dragged(page, SECONDS));
      list.push({ ...came, pending });
    }
  }
  const rows = [[`slipmap, while a slider moves, median and range of ${DRAGS} times ${SECONDS} s`]];
  for (const [searches, list] of all) {
    const title = titled(searches, Math.min(...list.map(({ pending }) => pending)));
    const ranged = (told, of) => {
      const found = list.map(of);
      const [least, most] = [Math.min(...found), Math.max(...found)];
      return `${told(median(found))} (${told(least)} to ${told(most)})`;
    };
    const percent = (part) => `${(100 * part).toFixed(1)} %`;
    const part = (of) => (one) => quantile(of(one), 0.95);
    rows.push([`${title}, from chart to chart, 95 %`, ranged(time, part((one) => one.between))]);
    rows.push([`${title}, under 20 ms`, ranged(percent, (one) => share(one.between, 20))]);
    rows.push([`${title}, from frame to frame, 95 %`, ranged(time, part((one) => one.frames))]);
    rows.push([`${title}, frames under 20 ms`, ranged(percent, (one) => share(one.frames, 20))]);
    rows.push([`${title}, cells while it moves`, list[0].cells.toLocaleString("en")]);
  }
  return rows;
}
