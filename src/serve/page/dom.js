// Small helpers to make elements.

/** @returns {HTMLElement} */
export const element = (id) => document.getElementById(id);

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

/** Rows of a list of terms. */
export function terms(list, rows) {
  const parts = rows.flatMap(([term, text]) => [make("dt", {}, term), make("dd", {}, text)]);
  list.replaceChildren(...parts);
}

/** Offers a file to the browser's downloads. */
export function download(name, content, type) {
  const blob = content instanceof Blob ? content : new Blob([content], { type });
  const link = make("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** Copies the text of a field, and says so on the button. */
export async function copy(field, button) {
  const { value } = field;
  try {
    await navigator.clipboard.writeText(value);
  } catch {
    field.select();
    document.execCommand("copy");
  }
  tellCopied(button);
}

/** Says on a button for a moment that it has copied. */
export function tellCopied(button) {
  const before = button.textContent;
  button.textContent = "Copied";
  setTimeout(() => (button.textContent = before), 1200);
}
