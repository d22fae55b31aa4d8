// The page's numbers are the CLI's bits: flights of shipped scenarios, asked here through the boundary and there through the
// program. Run by `web/test.sh`; FSPID names the program.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { inflateRawSync } from "node:zlib";
import { fromLetters, toLetters } from "../src/letters.mjs";

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

test("the difference between a loop and its model is of the model that fspid simulate flies, and none where both are the same", () => {
  const folder = mkdtempSync(join(tmpdir(), "fspid-bits-"));
  try {
    const trace = join(folder, "trace.csv");
    told("simulate", SCENARIOS[0], "--trace", trace);
    const table = csv(readFileSync(trace, "utf8"));
    const [time_s, theta, command] = ["time_s", "FSPID.theta_deg", "FSPID.command_deg"].map((name) => table.get(name));
    const asked = { verb: "compare", time_s: time_s.map((at) => at + 100), measured_deg: theta, begin_s: 100, model_s: time_s, theta_deg: theta, command_deg: command };
    const alike = ask({ ...asked, time_s, begin_s: 0 });
    assert.deepEqual(alike.json.difference, { largest_deg: 0, at_s: time_s.at(-1), rms_deg: 0, lines: time_s.length });
    same(alike.columns[alike.json.model_deg], theta, "theta");
    same(alike.columns[alike.json.command_deg], command, "command");
    // Off by three and four degrees at two lines, and at one line nothing is known.
    const measured_deg = theta.map((value, at) => (at === 5 ? value + 3 : at === 9 ? value - 4 : at === 11 ? null : value));
    const { json, columns } = ask({ ...asked, time_s, begin_s: 0, measured_deg });
    assert.equal(json.difference.lines, time_s.length - 1);
    assert.ok(Math.abs(json.difference.largest_deg + 4) < 1e-12 && json.difference.at_s === time_s[9]);
    assert.ok(Math.abs(json.difference.rms_deg - Math.sqrt(25 / (time_s.length - 1))) < 1e-12);
    assert.ok(Number.isNaN(columns[json.difference_deg][11]));
    assert.equal(ask({ ...asked, model_s: [], theta_deg: [], command_deg: [] }).json.difference, null);
  } finally {
    rmSync(folder, { recursive: true });
  }
});

test("memory stands still, however often a scenario is flown", () => {
  const text = readFileSync(join(root, SCENARIOS[0]), "utf8");
  for (let times = 0; times < 10; times += 1) ask({ verb: "fly", text });
  const before = exports.memory.buffer.byteLength;
  for (let times = 0; times < 100; times += 1) ask({ verb: "fly", text });
  assert.equal(exports.memory.buffer.byteLength, before);
});

test("bytes come back from letters, of which none means something in a page", () => {
  for (const count of [0, 1, 6, 7, 8, 255, 4096]) {
    const bytes = Uint8Array.from({ length: count }, (_, at) => (at * 167 + (at >> 3)) & 0xff);
    const letters = toLetters(bytes);
    assert.doesNotMatch(letters, /[\0\r<>&\x1b\x7f]/);
    assert.equal(Buffer.from(letters, "utf8").toString("utf8"), letters);
    assert.deepEqual(fromLetters(letters, count), bytes);
  }
  // Every pair of values stands somewhere in them.
  const all = Uint8Array.from({ length: 1 << 17 }, (_, at) => (at & 1 ? at >> 1 : at >> 9) & 0xff);
  assert.deepEqual(fromLetters(toLetters(all), all.length), all);
});

/** The files of an archive. */
function unpacked(archive) {
  const files = new Map();
  const bytes = Buffer.from(archive);
  let at = 0;
  while (bytes.readUInt32LE(at) === 0x04034b50) {
    const [packed, name] = [bytes.readUInt32LE(at + 18), bytes.readUInt16LE(at + 26)];
    const from = at + 30 + name + bytes.readUInt16LE(at + 28);
    files.set(bytes.toString("utf8", at + 30, at + 30 + name), inflateRawSync(bytes.subarray(from, from + packed)));
    at = from + packed;
  }
  return files;
}

/** Every file of a folder and of the folders in it. */
function filesOf(folder) {
  const all = readdirSync(folder, { recursive: true }).filter((name) => statSync(join(folder, name)).isFile());
  return all.sort();
}

const exported = readFileSync(join(root, SCENARIOS[0]), "utf8");
for (const target of ["c", "lua", "st", "rust", "simulink", "fmu2", "fmu3"]) {
  test(`what the page writes as ${target} is what fspid export writes, byte for byte`, () => {
    const folder = mkdtempSync(join(tmpdir(), "fspid-export-"));
    try {
      // A page has no compiler, so that its mock-up unit has no library.
      execFileSync(program, ["export", SCENARIOS[0], "--controller", "FSPID", "--to", target, "--out", folder], { cwd: root, stdio: "ignore", env: { ...process.env, CC: "false" } });
      const { json, columns } = ask({ verb: "export", text: exported, controller: "FSPID", target });
      const files = unpacked(new Uint8Array(columns[json.archive.at].buffer, 0, json.archive.bytes));
      assert.deepEqual([...files.keys()].sort(), filesOf(folder));
      for (const [name, bytes] of files) assert.ok(bytes.equals(readFileSync(join(folder, name))), name);
    } finally {
      rmSync(folder, { recursive: true });
    }
  });
}

test("the page says itself what it writes, and refuses the rest with a way out", () => {
  const { json } = ask({ verb: "open", text: exported });
  assert.deepEqual(json.targets, ["c", "lua", "st", "rust", "simulink", "fmu2", "fmu3"]);
  for (const target of ["matlab", "table"]) {
    assert.match(ask({ verb: "export", text: exported, controller: "FSPID", target }).json.refused, /`fspid export` does/);
  }
  assert.match(ask({ verb: "export", text: exported, controller: "FSPID", target: "cobol" }).json.refused, /known are c, lua/);
  assert.match(ask({ verb: "export", text: exported, controller: "Nobody", target: "c" }).json.refused, /no controller `Nobody`/);
});
