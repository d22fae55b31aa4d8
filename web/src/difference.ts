// What two texts differ in, line by line, with three lines around each difference.

export interface DifferentLine {
  sign: " " | "+" | "-" | "…";
  text: string;
}

const AROUND = 3;

/** The lines of both, those that are in one alone marked; far from a difference they are left out. */
export function difference(before: string, after: string): DifferentLine[] {
  if (before === after) return [];
  const [a, b] = [before.split("\n"), after.split("\n")];
  const all = walk(a, b, lengths(a, b));
  const near = (at: number) => all.slice(Math.max(0, at - AROUND), at + AROUND + 1).some((it) => it.sign !== " ");
  const kept: DifferentLine[] = [];
  all.forEach((line, at) => {
    if (near(at)) kept.push(line);
    else if (kept.at(-1)?.sign !== "…") kept.push({ sign: "…", text: "" });
  });
  return kept;
}

/** Lengths of the longest common subsequences of what is left of both. */
function lengths(a: string[], b: string[]): Uint32Array[] {
  const table = Array.from({ length: a.length + 1 }, () => new Uint32Array(b.length + 1));
  for (let i = a.length - 1; i >= 0; i -= 1) {
    for (let j = b.length - 1; j >= 0; j -= 1) {
      table[i]![j] = a[i] === b[j] ? table[i + 1]![j + 1]! + 1 : Math.max(table[i + 1]![j]!, table[i]![j + 1]!);
    }
  }
  return table;
}

function walk(a: string[], b: string[], table: Uint32Array[]): DifferentLine[] {
  const out: DifferentLine[] = [];
  let [i, j] = [0, 0];
  while (i < a.length || j < b.length) {
    if (i < a.length && j < b.length && a[i] === b[j]) {
      out.push({ sign: " ", text: a[i]! });
      i += 1;
      j += 1;
    } else if (j >= b.length || (i < a.length && table[i + 1]![j]! >= table[i]![j + 1]!)) {
      out.push({ sign: "-", text: a[i]! });
      i += 1;
    } else {
      out.push({ sign: "+", text: b[j]! });
      j += 1;
    }
  }
  return out;
}
