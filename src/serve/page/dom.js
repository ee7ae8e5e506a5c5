// Small helpers to make elements.

/** @returns {HTMLElement} */
export const element = (id) => document.getElementById(id);

/** @returns {HTMLInputElement} */
export const input = (id) => /** @type {HTMLInputElement} */ (element(id));

/**
 * A new element with properties and children.
 * @param {string} tag
 * @param {object} [properties]
 * @param {...(Node | string)} children
 */
export function make(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [key, value] of Object.entries(properties)) {
    if (key.startsWith("aria-") || key === "role" || key === "for") made.setAttribute(key, value);
    else made[key] = value;
  }
  made.append(...children);
  return made;
}

/** A text of more letters has a row of its own where terms stand beside one another. */
const LONG = 60;

/** Rows of a list of terms. */
export function terms(list, rows) {
  const parts = rows.map(([term, text]) => {
    const className = text.length > LONG ? "long" : "";
    return make("div", { className }, make("dt", {}, term), make("dd", {}, text));
  });
  list.replaceChildren(...parts);
}

/** The row of the warning of an answer; none without one. */
export const warned = ({ warning }) => (warning ? [["warning", warning]] : []);

/** Offers a file to the browser's downloads. */
export function download(name, content, type) {
  const blob = content instanceof Blob ? content : new Blob([content], { type });
  const link = make("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** Copies a text; whether the browser has done it. */
async function copied(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    // Without encryption there is no clipboard but the selection.
    const field = make("textarea", { value: text, readOnly: true, className: "aside" });
    const before = document.activeElement;
    document.body.append(field);
    field.select();
    const done = document.execCommand("copy");
    field.remove();
    before?.focus();
    return done;
  }
}

/** What buttons say while they do not tell of a copy. */
const labels = new WeakMap();

/** Copies a text, and says on the button for a moment what came of it. */
export async function copy(text, button, words = "Copied") {
  const told = (await copied(text)) ? words : "Not copied";
  const { label = button.textContent, timer } = labels.get(button) ?? {};
  clearTimeout(timer);
  button.textContent = told;
  const back = () => {
    button.textContent = label;
    labels.delete(button);
  };
  labels.set(button, { label, timer: setTimeout(back, 1200) });
}
