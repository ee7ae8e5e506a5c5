// The dialog that says how the page is used, and the key that opens it.

import { element, input } from "./dom.js";
import { Kept } from "./kept.js";

/** Whether the key is switched off: those who speak to their computer type it by chance. */
const switchedOff = new Kept("slipmap no help key", true);

/** Lets the button and the key open the dialog. */
export function offerHelp() {
  const dialog = /** @type {HTMLDialogElement} */ (element("help"));
  const byKey = input("help-key");
  byKey.checked = !switchedOff.read();
  byKey.addEventListener("change", () => switchedOff.write(byKey.checked ? null : true));
  element("to-help").addEventListener("click", () => dialog.showModal());
  document.addEventListener("keydown", (event) => {
    const typed = /** @type {HTMLElement} */ (event.target).matches("input, textarea, select");
    if (event.key === "?" && byKey.checked && !typed && !dialog.open) dialog.showModal();
  });
}
