// The same bits in WebAssembly: what the cockpit's mathematics answer, beside the program whose path is given. `fspid.wasm` of
// `web/build.sh` has verbs for flights, margins, certificates and exports; no verb makes `reproduce` or a campaign, so that every
// scenario that `reproduce` flies is flown here by itself.
import { createHash } from "node:crypto";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { inflateRawSync } from "node:zlib";

const root = fileURLToPath(new URL("../..", import.meta.url));
const program = process.argv[2];
const { exports } = (await WebAssembly.instantiate(readFileSync(join(root, "web/dist/fspid.wasm")), {})).instance;

/** An answer of the mathematics: its JSON, and its columns. */
function ask(question) {
  const bytes = new TextEncoder().encode(JSON.stringify(question));
  const room = exports.fspid_room(bytes.length);
  new Uint8Array(exports.memory.buffer, room, bytes.length).set(bytes);
  exports.fspid_ask();
  const [at, size] = [exports.fspid_answer_at(), exports.fspid_answer_bytes()];
  const answer = Buffer.from(exports.memory.buffer.slice(at, at + size));
  const [textBytes, count] = [answer.readUInt32LE(0), answer.readUInt32LE(4)];
  const begin = 8 + 4 * count;
  let next = Math.ceil((begin + textBytes) / 8) * 8;
  const columns = Array.from({ length: count }, (_, column) => {
    const length = 8 * answer.readUInt32LE(8 + 4 * column);
    next += length;
    return answer.subarray(next - length, next);
  });
  return { json: JSON.parse(answer.toString("utf8", begin, begin + textBytes)), columns };
}

/** What the program prints; that a requirement is not met is an answer too. */
function told(...parameters) {
  try {
    return execFileSync(program, parameters, { cwd: root, encoding: "utf8", maxBuffer: 1 << 28, stdio: ["ignore", "pipe", "ignore"], env: { ...process.env, CC: "false" } });
  } catch (error) {
    if (error.status === 1) return error.stdout;
    throw error;
  }
}

const sha = (text) => createHash("sha256").update(text).digest("hex");
const canonical = (value) => JSON.stringify(value);

/** The columns of a trace with the program's names, as the numbers that its CSV has; CSV has no signed zero. */
function table(text) {
  const [head, ...rows] = text.trimEnd().split("\n").map((line) => line.split(","));
  return new Map(head.map((name, at) => [name, rows.map((row) => row[at]).filter((cell) => cell !== "").map((cell) => Number(cell) + 0)]));
}

/** Both sides of every number of a flight: of the JSON, and of each column. */
function flight(scenario, folder) {
  const trace = join(folder, "trace.csv");
  const expected = [told("simulate", scenario, "--format", "json", "--trace", trace)];
  const { json, columns } = ask({ verb: "fly", text: readFileSync(join(root, scenario), "utf8") });
  const found = [canonical(json.simulation)];
  expected[0] = canonical(JSON.parse(expected[0]));
  const cells = table(readFileSync(trace, "utf8"));
  for (const { name, columns: own } of json.traces) {
    for (const { name: column, at } of own) {
      const bytes = columns[at];
      const values = Array.from({ length: bytes.length / 8 }, (_, row) => bytes.readDoubleLE(8 * row) + 0);
      found.push(canonical([name, column, values]));
      expected.push(canonical([name, column, (cells.get(column) ?? cells.get(`${name}.${column}`)).slice(0, values.length)]));
    }
  }
  return [found.join("\n"), expected.join("\n")];
}

/** The files of an archive, by their names. */
function unpacked(archive) {
  const bytes = Buffer.from(archive);
  const files = new Map();
  for (let at = 0; bytes.readUInt32LE(at) === 0x04034b50; ) {
    const from = at + 30 + bytes.readUInt16LE(at + 26) + bytes.readUInt16LE(at + 28);
    const name = bytes.toString("utf8", at + 30, at + 30 + bytes.readUInt16LE(at + 26));
    at = from + bytes.readUInt32LE(at + 18);
    files.set(name, inflateRawSync(bytes.subarray(from, at)).toString("base64"));
  }
  return [...files].sort();
}

function exported(target, scenario, folder) {
  told("export", scenario, "--controller", "FSPID", "--to", target, "--out", join(folder, target));
  const { json, columns } = ask({ verb: "export", text: readFileSync(join(root, scenario), "utf8"), controller: "FSPID", target });
  const names = readdirSync(join(folder, target), { recursive: true }).filter((name) => statSync(join(folder, target, name)).isFile());
  const expected = names.map((name) => [name, readFileSync(join(folder, target, name)).toString("base64")]).sort();
  return [canonical(unpacked(columns[json.archive.at].subarray(0, json.archive.bytes))), canonical(expected)];
}

function certified(scenario, folder) {
  told("certify", scenario, "--controller", "FSPID", "--out", join(folder, "certificates"));
  const { json } = ask({ verb: "certify", text: readFileSync(join(root, scenario), "utf8"), controller: "FSPID" });
  const names = readdirSync(join(folder, "certificates")).sort();
  const expected = names.map((name) => [name, readFileSync(join(folder, "certificates", name), "utf8")]);
  return [canonical(json.files.map((it) => [it.name, it.text])), canonical(expected)];
}

const paper = (of) => readdirSync(join(root, "data/paper", of)).filter((it) => it.endsWith(".toml")).sort().map((it) => `data/paper/${of}/${it}`);
const gallery = ["turn", "b747-turbulence", "ils-approach", "sensor-ahrs"].map((it) => `scenarios/gallery/${it}.toml`);
const step = "scenarios/747-pitch-step.toml";
const design = "data/designs/learned/light.toml";
const asked = [
  ...[...paper("own"), ...paper("shared"), ...gallery].map((it) => [`flight ${it}`, (folder) => flight(it, folder)]),
  ["certificate", (folder) => certified(step, folder)],
  ...["c", "rust", "st", "lua"].map((target) => [`export/${target}`, (folder) => exported(target, design, folder)]),
  ["margins", () => [canonical(ask({ verb: "judge", text: readFileSync(join(root, step), "utf8") }).json.analysis), canonical(JSON.parse(told("analyse", step, "--map", "0", "--format", "json")))]],
];

let different = 0;
for (const [name, both] of asked) {
  const folder = mkdtempSync(join(tmpdir(), "fspid-bits-"));
  try {
    const [found, expected] = both(folder);
    if (found === expected) continue;
    different += 1;
    console.log(`    ${name}: there ${sha(found)}, this machine ${sha(expected)}`);
  } finally {
    rmSync(folder, { recursive: true });
  }
}
console.log(`wasm (Node ${process.versions.node}): ${asked.length} answers, ${different} different; no verb for a report of \`reproduce\` and for campaigns`);
process.exit(different ? 1 : 0);
