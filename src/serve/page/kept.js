// What the browser keeps of the page; nothing where it does not allow that.

export class Kept {
  /**
   * @param {string} name
   * @param {boolean} [stays] whether it stays when the window is closed
   */
  constructor(name, stays = false) {
    Object.assign(this, { name, stays });
  }

  /** Where it is kept; naming that may throw. */
  get #place() {
    return this.stays ? localStorage : sessionStorage;
  }

  /** @returns {any} what was kept, or null */
  read() {
    try {
      return JSON.parse(this.#place.getItem(this.name) ?? "null");
    } catch {
      return null;
    }
  }

  /** Keeps something; nothing with null. */
  write(what) {
    try {
      if (what === null) this.#place.removeItem(this.name);
      else this.#place.setItem(this.name, JSON.stringify(what));
    } catch {
      // Then it is not kept.
    }
  }
}
