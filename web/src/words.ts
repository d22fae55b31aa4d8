// Numbers and names for people.

/** A number with at most `digits` significant digits, a real minus, no needless zeros. */
export function short(value: unknown, digits = 4): string {
  if (typeof value !== "number") return value === null || value === undefined ? "–" : String(value);
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "not a number" : value < 0 ? "−∞" : "∞";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text = size >= 1e6 || size < 1e-4 ? value.toExponential(digits - 1) : String(Number(value.toPrecision(digits)));
  return text.replace(/^-/, "−");
}

const UNITS: [suffix: string, unit: string][] = [
  ["_deg_s", "deg/s"], ["_rad_s", "rad/s"], ["_m_s", "m/s"], ["_deg_s2", "deg/s²"], ["_deg", "deg"], ["_rad", "rad"],
  ["_per_s", "1/s"], ["_s", "s"], ["_hz", "Hz"], ["_db", "dB"], ["_pct", "%"], ["_kg", "kg"], ["_m", "m"], ["_ft_s", "ft/s"], ["_ft", "ft"],
];

/** A key as words, with its unit once, in brackets. */
export function label(key: string, unit?: string): string {
  const found = UNITS.find(([suffix]) => key.endsWith(suffix));
  const stem = found ? key.slice(0, -found[0].length) : key;
  const told = unit || found?.[1] || "";
  const words = stem.replaceAll("_", " ");
  return told ? `${words} [${told}]` : words;
}

/** The number of a value as TOML writes a float: always with a point or an exponent. */
export function toml(value: number): string {
  const text = String(value);
  return /^-?\d+$/.test(text) ? `${text}.0` : text;
}

/** Measures of a whole flight whose keys are no names with a unit; the others are read off their names. */
const MEASURES: Record<string, string> = {
  iae: "IAE [deg s]",
  itae: "ITAE [deg s²]",
  ise: "ISE [deg² s]",
  itse: "ITSE [deg² s²]",
  command_variation: "command variation [deg]",
  command_max_deg: "largest command [deg]",
};

/** A measure with its unit. */
export function measure(name: string): string {
  return MEASURES[name] ?? label(name);
}

/** A measure whose unit was told with it: the unit of its name may be a product, as in `iae_deg_s`. */
export function titled(name: string, unit: string | null): string {
  return unit ? label(name.replace(/_deg2(?=_)/, ""), unit) : label(name);
}

/** What a flight of this outcome is: good, to be looked at, or bad. */
export function standing(good: boolean, failed: boolean): "good" | "fair" | "bad" {
  return failed ? "bad" : good ? "good" : "fair";
}

/** A sign for what colour says too. */
export const SIGN = { good: "✓", fair: "!", bad: "✗" } as const;

/** The same as a word, for whoever hears it: signs are spoken in many ways, or not at all. */
export const STANDING = { good: "good", fair: "to be looked at", bad: "bad" } as const;

/** The dash pattern and the colour of the series of this number: told apart without colour. */
export const DASHES: number[][] = [[], [8, 4], [2, 3], [10, 3, 2, 3], [5, 2], [1, 2]];
export const colour = (number: number): string => `--series-${number % 6}`;

/** A colour of the style sheet, for canvases. */
export function css(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim() || "#888";
}

/** As a shell takes it. */
export function quoted(text: string): string {
  return /^[\w.=+-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;
}
