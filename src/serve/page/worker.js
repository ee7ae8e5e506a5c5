// Answers of the WebAssembly module, one after the other, beside the page.

let module = null;

/** The answer to a request: its status, and its bytes. */
function answer(name, text) {
  const encoder = new TextEncoder();
  const [first, second] = [name, text].map((part) => encoder.encode(part));
  const length = first.length + second.length;
  // The memory is another one wherever it has grown.
  const begun = module.allocate(length) >>> 0;
  const room = new Uint8Array(module.memory.buffer, begun, length);
  room.set(first);
  room.set(second, first.length);
  const at = module.answer(first.length) >>> 0;
  const bytes = module.memory.buffer.slice(at, at + (module.length() >>> 0));
  const status = module.status();
  module.release();
  return { status, bytes };
}

onmessage = ({ data }) => {
  if (data.compiled) {
    module = new WebAssembly.Instance(data.compiled, {}).exports;
    return;
  }
  const begun = performance.now();
  try {
    const { status, bytes } = answer(data.name, data.text);
    const milliseconds = performance.now() - begun;
    postMessage({ status, bytes, milliseconds }, [bytes]);
  } catch (error) {
    // The module is in no state to go on.
    postMessage({ failed: String(error) });
  }
};
