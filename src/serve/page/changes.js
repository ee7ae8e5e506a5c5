// What the server tells of changes, by one stream for a tab that is seen.

/** How soon a stream that was refused is tried again, in milliseconds. */
const AGAIN = 4000;
const KINDS = ["jobs", "maps"];

export class Changes {
  /** @type {EventSource | null} */
  stream = null;

  /**
   * @param {{events: () => EventSource}} source see source.js
   * @param {{changed: (kind: string) => void, broken: () => void}} told
   */
  constructor(source, told) {
    this.source = source;
    this.told = told;
  }

  begin() {
    document.addEventListener("visibilitychange", () => this.again());
    this.again();
  }

  /** Opens the stream where there is none and the page is seen; of a hidden page it is closed. */
  again() {
    if (document.visibilityState !== "visible") this.close();
    else if (!this.stream) this.#open();
  }

  close() {
    clearTimeout(this.timer);
    this.stream?.close();
    this.stream = null;
  }

  #open() {
    clearTimeout(this.timer);
    const stream = this.source.events();
    this.stream = stream;
    // It begins with all that there is to be told.
    for (const kind of KINDS) stream.addEventListener(kind, () => this.told.changed(kind));
    stream.onerror = () => {
      if (this.stream !== stream) return;
      // One that was refused does not come back by itself.
      if (stream.readyState === EventSource.CLOSED) {
        this.stream = null;
        this.timer = setTimeout(() => this.again(), AGAIN);
      }
      this.told.broken();
    };
  }
}
