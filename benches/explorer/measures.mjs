// What all parts of the benchmark of the page share: figures, the state of the machine, a table.

import { readFileSync, readdirSync } from "node:fs";
import { cpus, loadavg } from "node:os";

/** The value below which a part of a list lies. */
export function quantile(list, part) {
  const all = [...list].sort((a, b) => a - b);
  return all[Math.min(all.length - 1, Math.floor(part * all.length))];
}

export const median = (list) => quantile(list, 0.5);

/** The part of a list that lies below a value. */
export const share = (list, most) => list.filter((one) => one < most).length / list.length;

/** A time with as many digits as mean something. */
export const time = (ms) => (ms < 1000 ? `${ms.toFixed(1)} ms` : `${(ms / 1000).toFixed(2)} s`);

/** What else the machine does; figures taken beside other work are worth little. */
export const load = () => {
  const list = loadavg().map((x) => x.toFixed(2)).join(", ");
  return `${list} (of 1, 5 and 15 minutes)`;
};

/** Processes as /proc tells of them: by number, their parents and the time that they took. */
function processes() {
  const all = new Map();
  for (const name of readdirSync("/proc").filter((text) => /^\d+$/.test(text))) {
    try {
      // The name of a program may hold spaces and parentheses; what follows does not.
      const words = readFileSync(`/proc/${name}/stat`, "utf8").split(") ").pop().split(" ");
      // Its own time and that of children that have ended, as user and in the kernel.
      const ticks = words.slice(11, 15).reduce((sum, word) => sum + Number(word), 0);
      all.set(Number(name), { parent: Number(words[1]), ticks });
    } catch {
      // It has ended meanwhile.
    }
  }
  return all;
}

/** A process, those that it has begun, and those that they have. */
function family(pid, all = processes()) {
  const list = [pid];
  for (const one of list) for (const [id, { parent }] of all) if (parent === one) list.push(id);
  return list;
}

/** The time that processors have taken for anything, for us, and in all; null where nobody says. */
function ticks() {
  try {
    const words = readFileSync("/proc/stat", "utf8").split("\n")[0].split(/ +/).slice(1, 9);
    const all = words.map(Number).reduce((a, b) => a + b, 0);
    const running = processes();
    const own = family(process.pid, running).reduce((sum, id) => sum + running.get(id).ticks, 0);
    // The fourth and fifth are idle, and waiting for a disk.
    return { all, own, busy: all - Number(words[3]) - Number(words[4]) };
  } catch {
    return null;
  }
}

/**
 * Begins to watch what else is computed beside this process and its children.
 * @returns {() => string} says it, as long as they live
 */
export function watchOthers() {
  const before = ticks();
  return () => {
    const after = ticks();
    if (!before || !after) return "not known on this system";
    const since = (key) => after[key] - before[key];
    const share = Math.max(0, (since("busy") - since("own")) / since("all"));
    const all = cpus().length;
    return `took ${(share * all).toFixed(2)} of ${all} processors`;
  };
}

/** What processes take in memory, shared pages counted by share, in MB; null where nobody says. */
export function memoryOf(pid) {
  try {
    const all = family(pid);
    const kilobytes = all.map((id) =>
      Number(/^Pss:\s+(\d+)/m.exec(readFileSync(`/proc/${id}/smaps_rollup`, "utf8"))[1]));
    return { processes: all.length, megabytes: kilobytes.reduce((a, b) => a + b, 0) / 1000 };
  } catch {
    return null;
  }
}

/** Prints rows of a plain table; a row of one text is a heading. */
export function printTable(rows) {
  const pairs = rows.filter((row) => row.length > 1);
  const width = Math.max(...pairs.map(([what]) => what.length));
  for (const [what, ...figures] of rows) {
    const line = figures.length ? `  ${what.padEnd(width)}  ${figures.join("  ")}` : `\n${what}`;
    console.log(line);
  }
}
