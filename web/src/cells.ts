// The nodes of a map that the program has drawn: where they lie in the drawing, and what each says.
import type { Answer } from "./wasm";
import type { Place } from "./parts/Reader.svelte";
import { short } from "./words";

export interface Cells {
  width: number;
  height: number;
  places: Place[];
}

/** Of the answer `figure` with a map; the drawing says where its panel is. */
export function cellsOf({ json, columns }: Answer): Cells | null {
  const drawing = new DOMParser().parseFromString(json.svg, "image/svg+xml").documentElement;
  const panel = drawing.querySelector<SVGElement>("[data-panel]")?.dataset["panel"];
  const [xs, ys, values] = [columns[json.nodes?.x], columns[json.nodes?.y], columns[json.nodes?.values]];
  if (!panel || !xs || !ys || !values) return null;
  const [left, top, width, height] = panel.split(" ").map(Number) as [number, number, number, number];
  const [xName, yName, name] = json.nodes.names;
  const [across, down] = [width / (xs.length - 1), height / (ys.length - 1)];
  const places = Array.from(values, (value, n): Place => {
    const [i, j] = [Math.floor(n / xs.length), n % xs.length];
    const [x, y] = [left + j * across, top + height - i * down];
    return {
      x, y,
      box: { x: x - across / 2, y: y - down / 2, width: across, height: down },
      text: `${yName} ${short(ys[i])}, ${xName} ${short(xs[j])}: ${name} ${Number.isFinite(value) ? short(value, 3) : "no value"}`,
    };
  });
  return { width: Number(drawing.getAttribute("width")), height: Number(drawing.getAttribute("height")), places };
}
