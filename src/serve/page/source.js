// Where answers come from: the server that this page comes from.

/** What is said instead of an answer. */
export class Problem extends Error {
  /** @param {{detail?: string, title?: string, help?: string, status?: number}} told */
  constructor(told) {
    super(told.detail ?? told.title ?? "no answer");
    this.help = told.help;
    this.status = told.status;
    this.span = told.span;
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
  for (let run = 0, from = 0; run < runs; from = ends[run++]) all.fill(values[run], from, ends[run]);
  return all;
}

const isArray = (of) => of && typeof of === "object" && of.type in TYPES && "offset" in of;

/** Puts the numbers of arrays where a head names them. */
function filled(of, bytes, begun) {
  if (!of || typeof of !== "object") return of;
  for (const [key, value] of Object.entries(of)) {
    if (isArray(value) && !("name" in value) && !("stable_side" in value)) of[key] = numbers(bytes, begun, value);
    else filled(value, bytes, begun);
  }
  if (isArray(of)) of.values = numbers(bytes, begun, of);
  return of;
}

/** An answer with many numbers. */
export function decode(bytes) {
  const length = new DataView(bytes).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
  return filled(head, bytes, Math.ceil((4 + length) / 8) * 8);
}

async function answered(response) {
  if (response.ok) return response;
  throw new Problem(await response.json().catch(() => ({ title: response.statusText })));
}

async function ask(path, toml, signal) {
  const headers = { "Content-Type": "application/toml" };
  return answered(await fetch(`api/v1/${path}`, { method: "POST", headers, body: toml, signal }));
}

const get = async (path, signal) => answered(await fetch(`api/v1/${path}`, { signal }));

export function openSource() {
  const json = (path) => async (toml, signal) => (await ask(path, toml, signal)).json();
  const binary = (path) => async (toml, signal) => decode(await (await ask(path, toml, signal)).arrayBuffer());
  const q = (query) => new URLSearchParams(query).toString();
  return {
    kind: "server",
    chart: binary("chart"), point: json("point"), vc: json("vc"), motion: binary("motion"), law: json("law"),
    parameters: async (signal) => (await get("parameters", signal)).json(),
    maps: async (signal) => (await get("maps", signal)).json(),
    map: async (id, signal) => (await get(`maps/${id}`, signal)).json(),
    window: async (id, query, signal) => decode(await (await get(`maps/${id}/window?${q(query)}`, signal)).arrayBuffer()),
    curves: async (id, query, signal) => decode(await (await get(`maps/${id}/curves?${q(query)}`, signal)).arrayBuffer()),
    cell: async (id, query, signal) => (await get(`maps/${id}/cell?${q(query)}`, signal)).json(),
    sweepText: async (id, signal) => (await get(`maps/${id}/sweep`, signal)).text(),
  };
}
