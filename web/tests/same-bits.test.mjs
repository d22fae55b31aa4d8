// The page's numbers are the CLI's bits: flights of shipped scenarios, asked here through the boundary and there through the
// program. Run by `web/test.sh`; FSPID names the program.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { before, test } from "node:test";
import { fileURLToPath } from "node:url";

const root = fileURLToPath(new URL("../..", import.meta.url));
const program = process.env.FSPID ?? join(root, "target/debug/fspid");
const SCENARIOS = ["scenarios/747-pitch-step.toml", "scenarios/limits.toml", "scenarios/disturbances.toml", "data/paper/own/figure-8a.toml"];

let exports;
before(async () => {
  const bytes = readFileSync(join(root, "web/dist/fspid.wasm"));
  exports = (await WebAssembly.instantiate(bytes, {})).instance.exports;
});

/** As `src/wasm.ts` asks. */
function ask(question) {
  const bytes = new TextEncoder().encode(JSON.stringify(question));
  const room = exports.fspid_room(bytes.length);
  new Uint8Array(exports.memory.buffer, room, bytes.length).set(bytes);
  exports.fspid_ask();
  const [at, size] = [exports.fspid_answer_at(), exports.fspid_answer_bytes()];
  const view = new DataView(exports.memory.buffer, at, size);
  const [textBytes, count] = [view.getUint32(0, true), view.getUint32(4, true)];
  const lengths = Array.from({ length: count }, (_, column) => view.getUint32(8 + 4 * column, true));
  const textAt = 8 + 4 * count;
  const text = new TextDecoder().decode(new Uint8Array(exports.memory.buffer, at + textAt, textBytes));
  let next = Math.ceil((textAt + textBytes) / 8) * 8;
  const columns = lengths.map((length) => {
    const column = new Float64Array(exports.memory.buffer.slice(at + next, at + next + 8 * length));
    next += 8 * length;
    return column;
  });
  return { json: JSON.parse(text), columns };
}

/** The program's answer; that a requirement is not met is an answer too. */
function told(...parameters) {
  try {
    return execFileSync(program, parameters, { cwd: root, encoding: "utf8", maxBuffer: 1 << 28, stdio: ["ignore", "pipe", "ignore"] });
  } catch (error) {
    if (error.status === 1) return error.stdout;
    throw error;
  }
}

/** The columns of the program's CSV by the names that they have there. */
function csv(text) {
  const [head, ...rows] = text.trimEnd().split("\n").map((line) => line.split(","));
  return new Map(head.map((name, at) => [name, rows.map((row) => row[at]).filter((cell) => cell !== "").map(Number)]));
}

/** CSV has no signed zero. */
const same = (found, expected, what) => {
  assert.equal(found.length, expected.length, `${what}: rows`);
  found.forEach((value, row) => assert.ok(Object.is(value + 0, expected[row] + 0), `${what}, row ${row}: ${value} is not ${expected[row]}`));
};

for (const scenario of SCENARIOS) {
  test(`${scenario} flies to the same bits as fspid simulate`, () => {
    const folder = mkdtempSync(join(tmpdir(), "fspid-bits-"));
    try {
      const trace = join(folder, "trace.csv");
      const expected = JSON.parse(told("simulate", scenario, "--format", "json", "--trace", trace));
      const { json, columns } = ask({ verb: "fly", text: readFileSync(join(root, scenario), "utf8") });
      assert.deepEqual(json.simulation, expected);
      const table = csv(readFileSync(trace, "utf8"));
      for (const { name, columns: own } of json.traces) {
        for (const { name: column, at } of own) {
          const cells = table.get(column) ?? table.get(`${name}.${column}`);
          assert.ok(cells, `${name}.${column} is not in the CSV`);
          same(columns[at], cells.slice(0, columns[at].length), `${name}.${column}`);
        }
      }
    } finally {
      rmSync(folder, { recursive: true });
    }
  });

  test(`${scenario} has the margins of fspid analyse, to the bit`, () => {
    const expected = JSON.parse(told("analyse", scenario, "--map", "0", "--format", "json"));
    const { json } = ask({ verb: "judge", text: readFileSync(join(root, scenario), "utf8") });
    assert.deepEqual(json.analysis, expected);
  });
}

test("a changed number flies as --set flies it", () => {
  const scenario = SCENARIOS[0];
  const [path, value] = ["controller.FSPID.supervisor.output_scale.kp", "0.4"];
  const expected = JSON.parse(told("simulate", scenario, "--set", `${path}=${value}`, "--format", "json"));
  const { json } = ask({ verb: "set", text: readFileSync(join(root, scenario), "utf8"), path, value });
  assert.deepEqual(ask({ verb: "fly", text: json.text }).json.simulation, expected);
});

test("an interval ends where fspid verify begins to refuse, and holds where it does not", () => {
  const scenario = "scenarios/requirements.toml";
  // Milder than its sets, which its controllers do not meet.
  const text = `${readFileSync(join(root, scenario), "utf8").split("[[requirement]]")[0]}[[requirement]]\nmeasure = "phase_margin_deg"\nleast = 35.0\n\n[[requirement]]\nmeasure = "overshoot_pct"\nmost = 45.0\n`;
  const folder = mkdtempSync(join(tmpdir(), "fspid-bits-"));
  const file = join(folder, "mild.toml");
  writeFileSync(file, text);
  const met = (path, value) => {
    const { requirements, failed_flights: failed = [] } = JSON.parse(told("verify", file, "--set", `${path}=${value}`, "--format", "json"));
    return [...requirements.filter((it) => !it.met), ...failed].every((it) => it.controller !== "FSPID");
  };
  try {
    let ends = 0;
    for (const path of ["controller.FSPID.nominal.kp", "controller.FSPID.nominal.kd", "controller.FSPID.supervisor.change_scale"]) {
      const { interval } = ask({ verb: "interval", text, path }).json;
      assert.equal(interval.holds, true, interval.text);
      assert.match(interval.asked, /^FSPID: 2 requirements/);
      for (const [end, beyond] of [[interval.least, interval.below], [interval.most, interval.above]]) {
        assert.ok(met(path, end), `${path}=${end}`);
        if (beyond?.kind !== "not met") continue;
        assert.ok(!met(path, beyond.value), `${path}=${beyond.value}: ${interval.text}`);
        ends += 1;
      }
      const inside = interval.values.filter(([value]) => value >= interval.least && value <= interval.most);
      assert.equal(inside.length, interval.inside);
      for (const [value, holds] of interval.values.filter((_, at) => at % 9 === 0)) assert.equal(met(path, value), holds, `${path}=${value}`);
    }
    assert.ok(ends >= 2, `${ends} ends`);
  } finally {
    rmSync(folder, { recursive: true });
  }
});

test("what is wrong has its line and column, and does not fly", () => {
  const { json } = ask({ verb: "open", text: "schema = 1\nnmae = 2\n" });
  const found = json.problems.find((it) => it.path === "nmae");
  assert.deepEqual([found.line, found.column], [2, 1]);
  assert.ok(ask({ verb: "fly", text: "schema = 1\nnmae = 2\n" }).json.problems.length > 0);
});

test("the parts of a command are the command, and the rules' shares the increments", () => {
  const text = readFileSync(join(root, SCENARIOS[0]), "utf8");
  for (const controller of ["PC", "CPID", "FSPID"]) {
    const { json } = ask({ verb: "explain", text, controller, at_s: 0.5 });
    const { proportional_deg, integral_deg, derivative_deg, rate_deg } = json.parts;
    const sum = proportional_deg + integral_deg + derivative_deg - rate_deg;
    // Each is turned into degrees for itself.
    assert.ok(Math.abs(sum - json.command_before_limits_deg) <= 1e-12 * Math.abs(sum), `${controller}: ${sum}`);
    for (const gain of json.supervisor ? ["kp", "ki", "kd"] : []) {
      const shares = json.supervisor.rules.reduce((all, rule) => all + (rule[gain]?.added ?? 0), 0);
      assert.ok(Math.abs(shares - json.supervisor.increments[gain]) <= 1e-9, `${gain}: ${shares}`);
    }
  }
});

test("memory stands still, however often a scenario is flown", () => {
  const text = readFileSync(join(root, SCENARIOS[0]), "utf8");
  for (let times = 0; times < 10; times += 1) ask({ verb: "fly", text });
  const before = exports.memory.buffer.byteLength;
  for (let times = 0; times < 100; times += 1) ask({ verb: "fly", text });
  assert.equal(exports.memory.buffer.byteLength, before);
});
