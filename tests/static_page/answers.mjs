// The worker of a static page as Node runs it: node answers.mjs PAGE REQUESTS.json FOLDER
// writes the answer to the i-th request to FOLDER/i, its status to FOLDER/i.status.

import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import vm from "node:vm";

const [page, requests, folder] = process.argv.slice(2);
const compiled = await WebAssembly.compile(readFileSync(join(page, "slipmap.wasm")));
const needed = WebAssembly.Module.imports(compiled);
if (needed.length > 0) throw new Error(`imports: ${JSON.stringify(needed)}`);

let told = null;
const worker = vm.createContext({
  TextEncoder,
  Uint8Array,
  WebAssembly,
  performance,
  postMessage: (message) => {
    told = message;
  },
});
vm.runInContext(readFileSync(join(page, "worker.js"), "utf8"), worker);
worker.onmessage({ data: { compiled } });

for (const [i, { name, text }] of JSON.parse(readFileSync(requests, "utf8")).entries()) {
  worker.onmessage({ data: { name, text } });
  if (told.failed) throw new Error(`${name}: ${told.failed}\n${text}`);
  writeFileSync(join(folder, `${i}`), new Uint8Array(told.bytes));
  writeFileSync(join(folder, `${i}.status`), `${told.status} ${told.milliseconds}`);
}
