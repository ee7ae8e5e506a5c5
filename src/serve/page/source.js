// Where answers come from: the server of this page or, where there is none, WebAssembly.

/** What is said instead of an answer. */
export class Problem extends Error {
  /**
   * @param {{detail?: string, title?: string, help?: string, status?: number, span?: number[]}} told
   * @param {string} [text] what was asked, in which `span` is a place
   */
  constructor(told, text) {
    super(told.detail ?? told.title ?? "no answer");
    this.help = told.help;
    this.status = told.status;
    this.span = told.span;
    this.text = text;
  }
}

const TYPES = { u8: Uint8Array, u16: Uint16Array, u32: Uint32Array, f64: Float64Array };

/** The numbers of an array, spread out where it is stored as runs. */
function numbers(bytes, begun, { type, offset, length, runs }) {
  const kind = TYPES[type];
  if (runs === undefined) return new kind(bytes, begun + offset, length);
  const values = new kind(bytes, begun + offset, runs);
  const behind = Math.ceil((runs * kind.BYTES_PER_ELEMENT) / 8) * 8;
  const ends = new Uint32Array(bytes, begun + offset + behind, runs);
  const all = new kind(length);
  for (let run = 0, from = 0; run < runs; from = ends[run++])
    all.fill(values[run], from, ends[run]);
  return all;
}

const isArray = (of) => of.type in TYPES && "offset" in of;

/** Puts numbers where a head names them: fields and curves get `values`, bare arrays become them. */
function filled(of, bytes, begun) {
  if (!of || typeof of !== "object") return of;
  if (isArray(of)) {
    const values = numbers(bytes, begun, of);
    if (!("name" in of || "stable_side" in of)) return values;
    if (of.gaps) of.gaps = numbers(bytes, begun, of.gaps);
    return Object.assign(of, { values });
  }
  for (const [key, value] of Object.entries(of)) of[key] = filled(value, bytes, begun);
  return of;
}

/**
 * An answer with many numbers, see src/explore/encoded.rs.
 * @param {ArrayBuffer} bytes
 */
export function decode(bytes) {
  const length = new DataView(bytes).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
  return filled(head, bytes, Math.ceil((4 + length) / 8) * 8);
}

/** How often a server that is busy is asked. */
const TRIES = 4;

/** @returns {Promise<void>} after so many milliseconds, unless nobody waits any more */
const pause = (time, signal) =>
  new Promise((resolve, reject) => {
    setTimeout(resolve, time);
    signal?.addEventListener("abort", () => reject(signal.reason), { once: true });
  });

/** A server: kind "server". */
function server() {
  const answered = async (response, text) => {
    if (response.ok) return response;
    const told = await response.json().catch(() => ({ title: response.statusText }));
    throw new Problem(told, text);
  };
  const send = async (method, path, kind, body, signal) => {
    const headers = kind ? { "Content-Type": `application/${kind}` } : {};
    const response = fetch(`api/v1/${path}`, { method, headers, body, signal });
    return answered(await response, body);
  };
  const post = (path, body, signal) => send("POST", path, "toml", body, signal);
  // Where the server is busy for a moment, it is asked again; what it computes may be too much.
  const get = async (path, signal) => {
    for (let tries = 1; ; tries++) {
      const response = await fetch(`api/v1/${path}`, { signal });
      const soon = Number(response.headers.get("Retry-After"));
      if (!soon || tries === TRIES) return answered(response);
      await pause(1000 * soon, signal);
    }
  };
  const decoded = async (response) => decode(await (await response).arrayBuffer());
  const json = async (response) => (await response).json();
  const of = (id, what, query) => `maps/${id}/${what}?${new URLSearchParams(query)}`;
  const job = (name) => `jobs/${encodeURIComponent(name)}`;
  const submit = async (toml, options) => {
    const said = Object.entries(options).filter(([, value]) => value);
    const response = await post(`jobs?${new URLSearchParams(said)}`, toml);
    return { job: await response.json(), isNew: response.status === 201 };
  };
  return {
    kind: "server",
    chart: (toml, signal) => decoded(post("chart", toml, signal)),
    point: (toml, signal) => json(post("point", toml, signal)),
    vc: (toml, signal) => json(post("vc", toml, signal)),
    best: (toml, signal) => json(post("best", toml, signal)),
    motion: (toml, signal) => decoded(post("motion", toml, signal)),
    law: (toml, signal) => json(post("law", toml, signal)),
    setting: (toml, signal) => json(post("setting", toml, signal)),
    formula: (toml, signal) => json(post("formula", toml, signal)),
    system: (toml, signal) => json(post("system", toml, signal)),
    parameters: (signal) => json(get("parameters", signal)),
    maps: (signal) => json(get("maps", signal)),
    visit: (file, signal) =>
      json(send("POST", `maps?${new URLSearchParams({ name: file.name })}`, "x-hdf5", file, signal)),
    map: (id, signal) => json(get(`maps/${id}`, signal)),
    window: (id, query, signal) => decoded(get(of(id, "window", query), signal)),
    curves: (id, query, signal) => decoded(get(of(id, "curves", query), signal)),
    cell: (id, query, signal) => json(get(of(id, "cell", query), signal)),
    stored: (id, signal) => decoded(get(`maps/${id}/motion`, signal)),
    sweepText: async (id, signal) => (await get(`maps/${id}/sweep`, signal)).text(),
    jobs: (signal) => json(get("jobs", signal)),
    job: (name, signal) => json(get(job(name), signal)),
    plan: (toml, timed, signal) => json(post(timed ? "plan?timed=true" : "plan", toml, signal)),
    submit,
    changeJob: (name, to) => json(send("PATCH", job(name), "json", JSON.stringify(to))),
    dropJob: (name, tiles) => send("DELETE", tiles ? `${job(name)}?tiles=true` : job(name)),
    events: () => new EventSource("api/v1/events"),
  };
}

/** How long what nobody waits for may go on, in milliseconds, and what somebody does. */
const [PATIENCE, LONGEST] = [250, 20_000];

/** Requests to a worker, one at a time. What takes too long ends with it; the next one has a new one. */
class Computing {
  #compiled;
  #newestFirst;
  #worker = null;
  #waiting = [];
  #current = null;

  /**
   * @param {Promise<WebAssembly.Module>} compiled
   * @param {boolean} newestFirst whether the newest request comes first; else they come in order
   */
  constructor(compiled, newestFirst) {
    [this.#compiled, this.#newestFirst] = [compiled, newestFirst];
  }

  /** @returns {Promise<{status: number, bytes: ArrayBuffer, milliseconds: number}>} */
  ask(name, text, signal) {
    return new Promise((resolve, reject) => {
      if (signal?.aborted) return reject(signal.reason);
      const asked = { name, text, resolve, reject };
      signal?.addEventListener("abort", () => this.#drop(asked, signal.reason), { once: true });
      this.#waiting.push(asked);
      this.#next();
    });
  }

  #drop(asked, reason) {
    asked.reject(reason);
    this.#waiting = this.#waiting.filter((other) => other !== asked);
    if (this.#current === asked) this.#endAfter(PATIENCE, reason);
  }

  /** Ends the worker if it is at the same then, counted from when it began. */
  #endAfter(time, reason) {
    const asked = this.#current;
    clearTimeout(asked.timer);
    const left = asked.begun + time - performance.now();
    asked.timer = setTimeout(() => this.#restart(reason), Math.max(0, left));
  }

  #restart(reason) {
    this.#worker?.terminate();
    this.#worker = null;
    this.#done((asked) => asked.reject(reason));
  }

  #done(tell) {
    const asked = this.#current;
    if (!asked) return;
    clearTimeout(asked.timer);
    this.#current = null;
    tell(asked);
    this.#next();
  }

  async #next() {
    if (this.#current || this.#waiting.length === 0) return;
    const asked = this.#newestFirst ? this.#waiting.pop() : this.#waiting.shift();
    this.#current = asked;
    asked.begun = performance.now();
    const detail = "it takes longer than 20 s: slipmap run has no such limit";
    this.#endAfter(LONGEST, new Problem({ status: 503, detail }));
    try {
      const compiled = await this.#compiled;
      if (this.#current !== asked) return;
      this.#worker ??= this.#begin(compiled);
      this.#worker.postMessage({ name: asked.name, text: asked.text });
    } catch (error) {
      const told = { status: 503, detail: `slipmap.wasm is not there: ${error.message}` };
      this.#done((asked) => asked.reject(new Problem(told)));
    }
  }

  #begin(compiled) {
    const worker = new Worker("worker.js");
    const failed = (why) => {
      const detail = "the computation failed; this is a fault of slipmap. It begins anew.";
      console.error(why);
      this.#restart(new Problem({ status: 500, detail }));
    };
    worker.onmessage = ({ data }) => {
      if (data.failed) failed(data.failed);
      else this.#done((asked) => asked.resolve(data));
    };
    worker.onerror = (event) => failed(event.message);
    worker.postMessage({ compiled });
    return worker;
  }
}

/** WebAssembly beside the page: kind "page". */
function page() {
  const load = async () => {
    const response = await fetch("slipmap.wasm");
    if (!response.ok) throw new Error(response.statusText);
    return WebAssembly.compile(await response.arrayBuffer());
  };
  const compiled = load();
  // Whoever asks is told.
  compiled.catch(() => {});
  // A chart does not wait for a critical velocity.
  const [charts, others] = [true, false].map((newest) => new Computing(compiled, newest));
  const ask = async (of, name, toml, signal) => {
    const answer = await of.ask(name, toml, signal);
    if (answer.status === 200) return answer;
    throw new Problem(JSON.parse(new TextDecoder().decode(answer.bytes)), toml);
  };
  const json = async (name, toml, signal) => {
    const { bytes } = await ask(others, name, toml, signal);
    return JSON.parse(new TextDecoder().decode(bytes));
  };
  return {
    kind: "page",
    chart: async (toml, signal) => {
      const { bytes, milliseconds } = await ask(charts, "chart", toml, signal);
      return Object.assign(decode(bytes), { milliseconds });
    },
    point: (toml, signal) => json("point", toml, signal),
    vc: (toml, signal) => json("vc", toml, signal),
    best: (toml, signal) => json("best", toml, signal),
    motion: async (toml, signal) => decode((await ask(others, "motion", toml, signal)).bytes),
    law: (toml, signal) => json("law", toml, signal),
    setting: (toml, signal) => json("setting", toml, signal),
    formula: (toml, signal) => json("formula", toml, signal),
    system: (toml, signal) => json("system", toml, signal),
    parameters: (signal) => json("parameters", "", signal),
  };
}

/** The one through which the page asks: a marker in its head says that there is no server. */
export function openSource() {
  const marker = document.querySelector('meta[name="slipmap-source"]');
  return marker?.content === "wasm" ? page() : server();
}
