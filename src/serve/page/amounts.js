// Amounts in words, as the command line has them.

/** @type {[number, string][]} */
const PREFIXES = [
  [1e12, " T"],
  [1e9, " G"],
  [1e6, " M"],
  [1e3, " k"],
];

const threeDigits = (value) => value.toFixed(value >= 99.95 ? 0 : value >= 9.995 ? 1 : 2);

/** A quantity with a decimal prefix and three digits, to which a unit is added: "12.3 M". */
function prefixed(value) {
  const [size, prefix] = PREFIXES.find(([least]) => value >= least) ?? [1, " "];
  return threeDigits(value / size) + prefix;
}

/** @param {number} n */
export const count = (n) => n.toLocaleString("en");

/** @param {number} n bytes */
export const bytes = (n) => (n < 1000 ? `${n} B` : `${prefixed(n)}B`);

/** @param {number} value cells in a second */
export const rate = (value) => `${prefixed(value).trimEnd()} cells/s`;

/** @param {number} s seconds */
export function seconds(s) {
  const whole = Math.round(s);
  if (whole < 60) return `${s < 9.995 ? s.toFixed(2) : s.toFixed(0)} s`;
  if (whole < 3600) return `${Math.floor(whole / 60)} min ${whole % 60} s`;
  const [hours, minutes] = [Math.floor(whole / 3600), Math.floor((whole % 3600) / 60)];
  if (whole < 360_000) return `${hours} h ${minutes} min`;
  return `${count(Math.floor(whole / 86_400))} days`;
}

/** An argument as a shell takes it. */
export const argument = (text) =>
  /^[\w./~@%+:,-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;
