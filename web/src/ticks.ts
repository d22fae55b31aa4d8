// Round numbers along an axis.

/** Multiples of 1, 2, 3 or 5 of a power of ten between two ends, about so many. */
export function ticks(low: number, high: number, about = 5): number[] {
  const rough = (high - low) / about;
  if (!(rough > 0) || !Number.isFinite(rough)) return [];
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 3, 5, 10].map((it) => it * power).find((it) => it >= rough * 0.999) ?? rough;
  const first = Math.ceil(low / step - 1e-9);
  const count = Math.floor(high / step + 1e-9) - first + 1;
  // Without the last digits that multiplying adds.
  return Array.from({ length: Math.max(0, count) }, (_, at) => Number(((first + at) * step).toPrecision(12)));
}
