// The source of a static page as Node runs it, with workers in place of the browser's that answer after the
// milliseconds that a request's text names: node source.mjs PAGE

import assert from "node:assert/strict";
import { copyFileSync, mkdtempSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const [page] = process.argv.slice(2);
const log = { begun: 0, ended: 0, asked: [] };

globalThis.Worker = class {
  constructor() {
    log.begun += 1;
  }
  postMessage({ compiled, name, text }) {
    if (compiled) return;
    log.asked.push(text);
    this.timer = setTimeout(
      () => {
        if (text === "fails 1") return this.onmessage({ data: { failed: "unreachable" } });
        const status = text.startsWith("wrong") ? 422 : 200;
        const told =
          status === 200
            ? { name, text }
            : { status, detail: "wrong", help: "right", span: [0, 5] };
        const bytes = new TextEncoder().encode(JSON.stringify(told)).buffer;
        this.onmessage({ data: { status, bytes, milliseconds: 1 } });
      },
      Number(text.split(" ")[1]),
    );
  }
  terminate() {
    clearTimeout(this.timer);
    log.ended += 1;
  }
};
globalThis.document = { querySelector: () => ({ content: "wasm" }) };
const empty = new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0]);
globalThis.fetch = async () => ({ ok: true, arrayBuffer: async () => empty.buffer });
console.error = () => {};

const copy = join(mkdtempSync(join(tmpdir(), "slipmap-")), "source.mjs");
copyFileSync(join(page, "source.js"), copy);
const { openSource, Problem, decode } = await import(pathToFileURL(copy));
const source = openSource();
assert.equal(source.kind, "page");
assert.equal(source.maps, undefined);

// In the order of asking.
const answers = await Promise.all(["a 30", "b 1", "c 1"].map((text) => source.point(text)));
assert.deepEqual(
  answers.map((answer) => answer.text),
  ["a 30", "b 1", "c 1"],
);
assert.deepEqual(log, { begun: 1, ended: 0, asked: ["a 30", "b 1", "c 1"] });

// Problems say what is wrong, where, and what helps.
const wrong = await source.vc("wrong 1").catch((error) => error);
assert.ok(wrong instanceof Problem);
assert.deepEqual(
  [wrong.message, wrong.help, wrong.status, wrong.span],
  ["wrong", "right", 422, [0, 5]],
);

// What nobody waits for any more is not asked, or its answer dropped, or its worker ended where it takes long.
const aborted = (promise) => assert.rejects(promise, { name: "AbortError" });
const [first, second] = [new AbortController(), new AbortController()];
const long = source.vc("long 60000", first.signal);
const never = source.vc("never 1", second.signal);
const after = source.point("after 1");
second.abort();
first.abort();
await Promise.all([aborted(long), aborted(never)]);
assert.equal((await after).text, "after 1");
assert.deepEqual([log.begun, log.ended, log.asked.includes("never 1")], [2, 1, false]);
const already = new AbortController();
already.abort();
await aborted(source.point("already 1", already.signal));

// A failure is a problem; the next request has a new worker.
const failed = await source.point("fails 1").catch((error) => error);
assert.ok(failed instanceof Problem && failed.status === 500);
assert.equal((await source.point("again 1")).text, "again 1");
assert.deepEqual([log.begun, log.ended], [3, 2]);

// Charts have their own worker, the newest one first.
log.asked = [];
const charts = ["x 20", "y 1", "z 1"].map((text) => source.chart(text).catch(() => {}));
await Promise.all(charts);
assert.deepEqual(log.asked, ["x 20", "z 1", "y 1"]);

// Bytes as src/explore/encoded.rs lays them out: bare arrays, and those of fields in runs.
const head = JSON.stringify({
  arrays: { t: { type: "f64", offset: 0, length: 2 } },
  fields: [{ name: "n", type: "u16", offset: 16, length: 5, runs: 2 }],
});
const begun = Math.ceil((4 + head.length) / 8) * 8;
const bytes = new ArrayBuffer(begun + 32);
new DataView(bytes).setUint32(0, head.length, true);
new Uint8Array(bytes, 4).set(new TextEncoder().encode(head));
new Float64Array(bytes, begun, 2).set([0.5, 1.5]);
new Uint16Array(bytes, begun + 16, 2).set([7, 9]);
new Uint32Array(bytes, begun + 24, 2).set([3, 5]);
const decoded = decode(bytes);
assert.deepEqual([...decoded.arrays.t], [0.5, 1.5]);
assert.deepEqual([...decoded.fields[0].values], [7, 7, 7, 9, 9]);
assert.equal(decoded.fields[0].name, "n");
