// Files that are dropped onto the page: measured friction curves, and texts of settings.

import { GAINS, SHOWN, UNITS } from "./catalogue.js";
import { element } from "./dom.js";
import { bytesOf, textOf } from "./file.js";
import { parametersOf } from "./sweep.js";

/** How names of measured curves, of texts of settings and of maps end. */
const [CURVES, TEXTS, MAPS] = [
  ["csv", "tsv", "txt", "dat"],
  ["toml"],
  ["h5", "hdf5", "nc"],
];
/** The most bytes of a map that the server takes. */
const LARGEST_MAP = 2 ** 26;

/** What can be dropped. */
const OFFER = "A friction curve (CSV), a sweep, case or setting (TOML), or a map (HDF5)";

const ending = ({ name }) => name.split(".").pop().toLowerCase();

/** Which of the units that the page offers these are; none where it does not offer them. */
const offered = (units) => {
  if (!units) return "";
  const joined = units.join(",");
  return joined in UNITS ? joined : null;
};

/**
 * Sets a view to what a file says, and returns what of it the page cannot show, in words.
 * @param {object} state
 * @param {import("./catalogue.js").Catalogue} catalogue
 * @param {object} given the answer about the file
 */
export function take(state, catalogue, given) {
  const { values, law, axes } = given;
  const notes = given.left_out.map((key) => `${key} is not followed on the page`);
  [state.model, state.law] = ["", law ?? "none"];
  if (given.formula !== null) state.formula = given.formula;
  state.table = given.points.map((row) => row.join(", ")).join("\n");
  [state.columns, state.speedUnit, state.highest] = ["", "", 0];
  const units = offered(given.units);
  if (units === null) notes.push(`units ${given.units.join(", ")} are not offered by the page`);
  state.units = units ?? "";
  const used = (gain) => values[gain] || axes.some(({ name }) => name === gain);
  const both = GAINS.mixed.every(used);
  state.control = both ? "mixed" : used("alpha_n") ? "load" : "velocity";
  state.values = { ...values };
  const field = given.fields.find((name) => SHOWN.includes(name));
  state.show = field ?? "n_unstable";
  const known = parametersOf(state, catalogue);
  const shown = [];
  for (const { name, from, to, middle, log } of axes) {
    const axis = { name, from, to, log };
    const fits = known.includes(name) && !catalogue.wrong(axis);
    // The last axes of a sweep are those of its planes.
    if (fits) shown.push(axis);
    else notes.push(`the axis ${name} is not one of the page`);
    state.values[name] = middle;
  }
  const [x, y] = shown.slice(-2);
  if (x && y) [state.x, state.y] = [x, y];
  else if (x?.name === "tau") {
    [state.x, state.y] = [catalogue.axis(GAINS[state.control][0], state, x), x];
  } else if (x) [state.x, state.y] = [x, catalogue.axis("tau", state, x)];
  catalogue.mendAxes(state, known, 0);
  const point = [state.x, state.y].map(({ name }) => values[name]);
  state.point = point.every(Number.isFinite) ? point : null;
  const { x_dot0: u, a0: a = 0 } = values;
  state.start = Number.isFinite(u) ? [u, a] : null;
  return notes;
}

export class Dropped {
  /**
   * @param {object} source see source.js
   * @param {{curve: (text: string) => void, setting: (given: object, name: string) => void,
   *   map: (id: string) => void, failed: (error: Error) => void}} done
   */
  constructor(source, done) {
    Object.assign(this, { source, ...done });
    const over = element("dropping");
    over.textContent = OFFER;
    const files = ({ dataTransfer }) => dataTransfer?.types.includes("Files");
    document.addEventListener("dragover", (event) => {
      if (!files(event)) return;
      event.preventDefault();
      over.hidden = false;
    });
    document.addEventListener("dragleave", (event) => {
      if (!event.relatedTarget) over.hidden = !this.visiting;
    });
    document.addEventListener("drop", (event) => {
      if (!files(event)) return;
      event.preventDefault();
      over.hidden = !this.visiting;
      this.#read([...event.dataTransfer.files]);
    });
    element("file").addEventListener("change", ({ target }) => {
      this.#read([...target.files]);
      target.value = "";
    });
  }

  async #read(files) {
    try {
      if (files.length !== 1) throw new RangeError("one file at a time is read");
      await this.#take(files[0]);
    } catch (error) {
      const [file] = files;
      if (file) error.message = `${file.name}: ${error.message}`;
      this.failed(error);
    }
  }

  async #take(file) {
    const kind = ending(file);
    if (MAPS.includes(kind)) {
      await this.#visit(file);
      return;
    }
    const curve = CURVES.includes(kind);
    if (!curve && !TEXTS.includes(kind)) {
      const known = [...CURVES, ...TEXTS, ...MAPS].map((of) => `.${of}`).join(", ");
      throw new RangeError(`a file that ends with one of ${known} is read`);
    }
    const text = await textOf(file, { strict: !curve });
    if (curve) this.curve(text);
    else await this.setting(await this.source.setting(text), file.name);
  }

  /** Lets the server look at a map, which it does not keep. */
  async #visit(file) {
    const instead = "put it into a folder that `slipmap serve FOLDER` shows";
    if (!this.source.visit) throw new RangeError(`this page has no server: ${instead}`);
    if (file.size > LARGEST_MAP) {
      throw new RangeError(`${file.size} bytes; at most ${LARGEST_MAP} are taken: ${instead}`);
    }
    // What the browser cannot read is not the server's fault.
    await bytesOf(file.slice(0, 1));
    this.visiting?.abort();
    const visiting = new AbortController();
    Object.assign(this, { visiting });
    this.#say(`Reading ${file.name} …`);
    try {
      const { id } = await this.source.visit(file, visiting.signal);
      if (!visiting.signal.aborted) this.map(id);
    } catch (error) {
      // Another one was dropped meanwhile.
      if (!visiting.signal.aborted) throw error;
    } finally {
      if (this.visiting === visiting) {
        this.visiting = null;
        this.#say(null);
      }
    }
  }

  /** What is said over the page: of a map that is sent, else nothing. */
  #say(words) {
    const over = element("dropping");
    [over.hidden, over.textContent] = [words === null, words ?? OFFER];
  }
}
