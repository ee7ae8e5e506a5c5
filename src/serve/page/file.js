// Texts in files that are chosen or dropped.

/** The most bytes of a text that the server takes. */
const MOST = 2 ** 18;

/**
 * @param {Blob} file
 * @returns {Promise<ArrayBuffer>}
 * @throws what cannot be read, such as a folder
 */
export async function bytesOf(file) {
  try {
    return await file.arrayBuffer();
  } catch {
    throw new RangeError("it cannot be read");
  }
}

/**
 * @param {File} file
 * @param {{strict?: boolean}} [how] whether what is not UTF-8 is refused, or read as well as it can be
 * @returns {Promise<string>} its text
 * @throws a file that is too long or no text
 */
export async function textOf(file, { strict = true } = {}) {
  if (file.size > MOST) throw new RangeError(`${file.size} bytes; at most ${MOST} are read`);
  const bytes = await bytesOf(file);
  let text = "";
  try {
    text = new TextDecoder("utf-8", { fatal: strict }).decode(bytes);
  } catch {
    throw new RangeError("it is no text in UTF-8");
  }
  if (text.includes("\0")) throw new RangeError("it is no text");
  return text;
}
