// What a map of the program says of its nodes: the same that reports read under their cursor.
import type { Place } from "./parts/Reader.svelte";
import { short } from "./words";

export interface Cells {
  width: number;
  height: number;
  places: Place[];
}

/** Levels are two letters of this base, up to the last of them. */
const BASE = 36;
const LAST = BASE * BASE - 1;

/** The nodes of a map of graded values. */
export function cellsOf(svg: string): Cells | null {
  const drawing = new DOMParser().parseFromString(svg, "image/svg+xml").documentElement;
  const group = drawing.querySelector<SVGElement>("[data-levels]");
  if (!group) return null;
  const { panel, levels, columns, rows, cells, quantity = "" } = group.dataset as Record<string, string>;
  const numbers = (text = "") => text.split(" ").map((it) => Number(it.replace("−", "-")));
  const [left, top, width, height] = numbers(panel) as [number, number, number, number];
  const [low, high] = numbers(levels) as [number, number];
  const [xs, ys] = [numbers(columns), numbers(rows)];
  const name = (axis: string) => drawing.querySelector<SVGElement>(`[data-axis="${axis}"]`)?.dataset["label"] ?? axis;
  const [xName, yName] = [name("x"), name("y")];
  const places = (cells?.match(/../g) ?? []).map((two, n): Place => {
    const [i, j] = [Math.floor(n / xs.length), n % xs.length];
    const value = low + (parseInt(two, BASE) / LAST) * (high - low);
    const [x, y] = [left + (j / (xs.length - 1)) * width, top + (1 - i / (ys.length - 1)) * height];
    const [across, down] = [width / (xs.length - 1), height / (ys.length - 1)];
    return {
      x, y,
      box: { x: x - across / 2, y: y - down / 2, width: across, height: down },
      text: `${yName} ${short(ys[i])}, ${xName} ${short(xs[j])}: ${quantity} ${Number.isNaN(value) ? "no value" : short(value, 3)}`,
    };
  });
  return { width: Number(drawing.getAttribute("width")), height: Number(drawing.getAttribute("height")), places };
}
