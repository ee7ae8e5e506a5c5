// How fast the page is in a headless Chromium: frames of the live chart while a slider moves, charts
// beside slow requests, and views of a map of 10⁹ cells; with --peers also heat maps of others at the same work, in turn.
//
//   scripts/browser.sh bench [--seconds N] [--map FOLDER] [--peers]
//
// Each program's slider moves for N seconds in all. FOLDER holds the map, or gets it.

import { join } from "node:path";
import { parseArgs } from "node:util";
import { ROOT, newFolder, openBrowser, openPage, serve, slipmap } from "./support.mjs";
import { rowsOfBeside } from "./explorer/beside.mjs";
import { chartsOfSteps, dragged, framesOf } from "./explorer/live.mjs";
import { measureMap, rowsOfMap } from "./explorer/map.mjs";
import { load, printTable, watchOthers } from "./explorer/measures.mjs";
import {
  installedPeers, openPeer, steppedPeer, stillOf, stillTitle,
} from "./explorer/peers.mjs";

/** How often the programs take turns. */
const TURNS = 2;
/** Charts that peers are given for the steps of their slider. */
const CHARTS = 60;

const { values: options } = parseArgs({
  options: {
    seconds: { type: "string", default: "8" },
    map: { type: "string", default: join(ROOT, "target/browser/maps") },
    peers: { type: "boolean", default: false },
  },
});
const seconds = Number(options.seconds);
if (!(seconds > 0)) {
  console.error(`error: --seconds ${options.seconds}: a number above 0 is needed`);
  process.exit(1);
}

/** What draws WebGL, which peers use and slipmap does not. */
const webgl = () => {
  const context = document.createElement("canvas").getContext("webgl2");
  const names = context?.getExtension("WEBGL_debug_renderer_info");
  return names ? context.getParameter(names.UNMASKED_RENDERER_WEBGL) : "none";
};

/** What is done, or nothing where a peer fails, which is said. */
async function attempt(peer, act) {
  try {
    return await act();
  } catch (error) {
    console.log(`${peer.name}: could not be measured, ${error.message.split("\n")[0]}`);
    return null;
  }
}

/** The live chart and its peers in turn; titles with rows of a table. */
async function measureLive(browser, peers) {
  const server = await serve([newFolder()]);
  const page = await openPage(browser, server.link);
  const about = await page.evaluate(async () => {
    const { FEWER_CELLS: cells } = await import("./live.js");
    const { canvas, view } = window.slipmap.plane;
    const [x, y] = view.map(({ from, to }) => [from, to]);
    return { size: [canvas.clientWidth, canvas.clientHeight], x, y, cells };
  });
  const programs = [{ title: "slipmap, live chart", turn: () => dragged(page, seconds / TURNS) }];
  const charts = peers.length ? await chartsOfSteps(page, CHARTS) : [];
  for (const peer of peers) {
    const other = await attempt(peer, () => openPeer(browser, peer, charts, about));
    if (!other) continue;
    const turn = () => steppedPeer(other, seconds / TURNS);
    programs.push({ title: `${peer.name} ${peer.version}, the same charts`, turn, other, peer });
  }
  for (const program of programs) program.told = [];
  for (let turn = 0; turn < TURNS; turn++) {
    for (const program of programs) {
      // A page that is not in front may be held back.
      await (program.other ?? page).bringToFront();
      program.told.push(await program.turn());
    }
  }
  const beside = await rowsOfBeside(page);
  const rows = programs.flatMap(({ title, told }) => [[title], ...framesOf(told)]);
  for (const { peer } of programs.filter((one) => one.peer?.still)) {
    const still = await attempt(peer, () => stillOf(browser, peer, about.size));
    if (still) rows.push([`${peer.name} ${peer.version}, ${stillTitle}`], ...still);
  }
  const pages = programs.map(({ other }) => other ?? page);
  const faults = pages.flatMap((one) => one.faults);
  for (const one of pages) await one.context().close();
  await server.end();
  return { rows, beside, faults, about };
}

const [before, others] = [load(), watchOthers()];
const peers = options.peers ? installedPeers((line) => console.log(line)) : [];
// Those that draw by WebGL need it from the processor here; all are measured with these flags.
const browser = await openBrowser(["--enable-unsafe-swiftshader"]);
const live = await measureLive(browser, peers);
const map = await measureMap(browser, options.map);
const drawing = await (await openPage(browser, null)).evaluate(webgl);
printTable([
  ["measured with"],
  ["slipmap", slipmap(["--version"]).trim()],
  ["Chromium", `${browser.version()}, headless, without a GPU`],
  ["WebGL", drawing],
  ["load before", before],
  ["load after", load()],
  ["other work meanwhile", others()],
  ["live charts while a slider moves", `${live.about.cells.join(" × ")} cells`],
  ["charts with their axes", `${live.about.size.join(" × ")} pixels`],
  ...live.rows,
  ...live.beside,
  ["slipmap, map of 10⁹ cells"],
  ...rowsOfMap(map),
]);
console.log(`
Input to pixels: from the input to the beginning of the frame after the drawing.
Beside other work (see above) figures mean little.`);
if (peers.length) {
  console.log(`
slipmap computes each of its charts and draws curves over it; peers are handed theirs and draw none.
At most two charts are under way in each program. What WebGL draws is waited for only where an array
is in memory, by reading a pixel. Where the processor draws it, as it does where "SwiftShader"
stands above, peers that use it are at a disadvantage: with a GPU they are faster.`);
}
for (const fault of [...live.faults, ...map.faults]) console.log(`fault: ${fault}`);
await browser.close();
