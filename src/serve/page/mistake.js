// The place of a mistake in a text that was asked about.

/**
 * Parts of the text: before, in and behind the place.
 * @param {{text: string, span: number[]}} mistake
 */
export function partsOf({ text, span }) {
  const bytes = new TextEncoder().encode(text);
  const part = (from, to) => new TextDecoder().decode(bytes.subarray(from, to));
  const [from, to] = span.map((at) => Math.min(bytes.length, Math.max(0, at)));
  return [part(0, from), part(from, to), part(to, bytes.length)];
}

/**
 * Line and column of a mistake, beginning with 1; null where it has no place.
 * @param {{text?: string, span?: number[]}} mistake
 */
export function placeOf({ text, span }) {
  if (!span || text === undefined) return null;
  const lines = partsOf({ text, span })[0].split("\n");
  return { line: lines.length, column: [...lines[lines.length - 1]].length + 1 };
}
