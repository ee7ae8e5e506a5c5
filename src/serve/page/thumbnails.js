// Small pictures of maps, each made of a window of it when it is in sight.

import { paint } from "./cells.js";
import { coloursOf } from "./colours.js";
import { make } from "./dom.js";

/** Pixels across and up. */
const [WIDTH, HEIGHT] = [96, 64];
/** So many are asked for at a time: maps that are looked at come first. */
const AT_A_TIME = 1;
/** One of a map that grows is not made again before, in milliseconds. */
const AGAIN = 15_000;
/** How often, and how soon, a window that is not read yet is asked for again. */
const [TRIES, SOON] = [20, 250];

export class Thumbnails {
  /** @param {object} source see source.js */
  constructor(source) {
    this.source = source;
    /** By the id of a map: its canvas, and of what it was made, when. */
    this.known = new Map();
    [this.waiting, this.underWay] = [new Set(), 0];
    this.sight = new IntersectionObserver((seen) => {
      for (const { target, isIntersecting } of seen) {
        const { id } = target.dataset;
        if (isIntersecting) this.waiting.add(id);
        else this.waiting.delete(id);
      }
      this.#next();
    });
  }

  /** The canvas of a map, empty until it has come in sight. */
  of(map) {
    const version = `${map.state} ${map.cells_done} ${map.modified}`;
    const { id } = map;
    const known = this.known.get(id);
    if (known) {
      Object.assign(known, { map, version });
      // What is in sight is told anew.
      this.sight.unobserve(known.canvas);
      this.sight.observe(known.canvas);
      return known.canvas;
    }
    const canvas = make("canvas", { width: WIDTH, height: HEIGHT, className: "thumbnail" });
    canvas.setAttribute("aria-hidden", "true");
    canvas.dataset.id = id;
    this.known.set(id, { canvas, map, version, made: null, at: -Infinity });
    this.sight.observe(canvas);
    return canvas;
  }

  /** Forgets all but these maps. */
  keep(maps) {
    const there = new Set(maps.map(({ id }) => id));
    for (const [id, { canvas }] of this.known) {
      if (there.has(id)) continue;
      this.sight.unobserve(canvas);
      this.waiting.delete(id);
      this.known.delete(id);
    }
  }

  #next() {
    for (const id of this.waiting) {
      if (this.underWay === AT_A_TIME) return;
      this.waiting.delete(id);
      const known = this.known.get(id);
      if (!known || known.made === known.version || !this.#hasPicture(known.map)) continue;
      if (performance.now() - known.at < AGAIN) {
        this.#later(known);
        continue;
      }
      this.underWay += 1;
      known.at = performance.now();
      const { version } = known;
      this.#make(id, known.canvas)
        .then(() => (known.made = version))
        // Without it the row says the same.
        .catch(() => this.#later(known))
        .finally(() => {
          this.underWay -= 1;
          this.#next();
        });
    }
  }

  /** Whether a map has anything to be seen: not one that has just begun. */
  #hasPicture({ axes, cells_done: done }) {
    return (axes ?? []).length > 0 && done !== 0;
  }

  /** Tries again if it is in sight then. */
  #later(known) {
    known.timer ??= setTimeout(() => {
      known.timer = null;
      this.sight.unobserve(known.canvas);
      if (known.canvas.isConnected) this.sight.observe(known.canvas);
    }, AGAIN);
  }

  async #make(id, canvas) {
    const map = await this.source.map(id);
    const { field: name, x, y } = map.first;
    const others = map.axes.filter((axis) => axis.name !== x && axis.name !== y);
    const at = others.map((axis) => `${axis.name}:${Math.floor(axis.points / 2)}`).join(",");
    const query = { field: name, x, at, w: WIDTH, h: y ? HEIGHT : 1, ...(y ? { y } : {}) };
    let answer = await this.source.window(id, query);
    for (let tries = 1; !answer.complete && tries < TRIES; tries++) {
      await new Promise((done) => setTimeout(done, SOON));
      answer = await this.source.window(id, query);
    }
    const field = map.fields.find((each) => each.name === name);
    const { values: cells, bits, gaps, shown } = answer;
    const [nx, ny] = [answer.x.values.length, answer.y?.values.length ?? 1];
    const image = document.createElement("canvas");
    // At this size dots for what is hidden would be all that is seen.
    const plain = bits.map((bit) => bit & ~1);
    const colours = coloursOf(field, shown);
    paint(image, { nx, ny, field, cells, gaps, shown, bits: plain, colours });
    const context = canvas.getContext("2d");
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, WIDTH, HEIGHT);
    context.imageSmoothingEnabled = false;
    // Rows of the image go upwards, beside one another.
    context.setTransform(0, -HEIGHT / ny, WIDTH / nx, 0, 0, HEIGHT);
    context.drawImage(image, 0, 0);
  }
}
