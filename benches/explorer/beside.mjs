// Charts while critical velocities are computed: how long each takes from request to answer.

import { atRest } from "../support.mjs";
import { quantile, time } from "./measures.mjs";

/** Charts that are asked for in turn, and critical velocities that are waited for meanwhile. */
const [CHARTS, SLOW] = [50, 4];

/** Asks for charts in turn, while as many searches as asked for are under way. */
const charts = async ([count, searches]) => {
  const { live, source, state } = window.slipmap;
  const leaving = new AbortController();
  const law = '[friction]\nlaw = "weakening"\nmu0 = 0.5\nv_s = 0.5\n';
  let left = searches;
  for (let n = 0; n < searches; n++) {
    const text = `[fixed]\nalpha_v = -0.33\ntau = ${900 + n}\n${law}`;
    source.vc(text, leaving.signal).catch(() => {}).finally(() => (left -= 1));
  }
  await new Promise((done) => setTimeout(done, 300));
  const text = live.text(state, [200, 150], ["n_unstable"]);
  const took = [];
  for (let n = 0; n < count; n++) {
    const begun = performance.now();
    await source.chart(text);
    took.push(performance.now() - begun);
  }
  // One that is done by now was none to wait for.
  const pending = left;
  leaving.abort();
  return { took, pending };
};

/** Rows of a table: charts alone, and beside critical velocities. */
export async function rowsOfBeside(page) {
  await atRest(page);
  const rows = [];
  for (const searches of [0, SLOW]) {
    const { took, pending } = await page.evaluate(charts, [CHARTS, searches]);
    const beside = searches ? `beside ${searches} vc (${pending} still pending)` : "alone";
    rows.push([`${beside}, median`, time(quantile(took, 0.5))]);
    rows.push([`${beside}, 95 %`, time(quantile(took, 0.95))]);
  }
  return rows;
}
