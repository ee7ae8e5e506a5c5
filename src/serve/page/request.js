// Requests to the server: TOML there, arrays or JSON back.

/** What the server says instead of an answer. */
export class Problem extends Error {
  /** @param {{detail?: string, title?: string, help?: string}} told */
  constructor(told) {
    super(told.detail ?? told.title ?? "no answer");
    this.help = told.help;
  }
}

/**
 * @param {string} path
 * @param {string} toml
 * @param {AbortSignal} signal
 * @returns {Promise<Response>}
 */
async function ask(path, toml, signal) {
  const headers = { "Content-Type": "application/toml" };
  const response = await fetch(`api/v1/${path}`, { method: "POST", headers, body: toml, signal });
  if (!response.ok) {
    throw new Problem(await response.json().catch(() => ({ title: response.statusText })));
  }
  return response;
}

/** The rightmost roots, stable delays and the margin at a point. */
export async function askPoint(toml, signal) {
  return (await ask("point", toml, signal)).json();
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

/** A chart: its axes, and its fields and curves with their numbers. */
export async function askChart(toml, signal) {
  const bytes = await (await ask("chart", toml, signal)).arrayBuffer();
  const length = new DataView(bytes).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
  const begun = Math.ceil((4 + length) / 8) * 8;
  for (const of of [...head.fields, ...head.curves]) of.values = numbers(bytes, begun, of);
  return head;
}
