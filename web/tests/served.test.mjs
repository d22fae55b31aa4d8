// The page behind the real program, in a real browser: jobs, worst runs, telemetry, saving. Run by `web/test.sh`; CHROMIUM
// names the browser and FSPID the program.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { createSocket } from "node:dgram";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

const path = (name) => fileURLToPath(new URL(name, import.meta.url));
const PROGRAM = process.env.FSPID ?? path("../../target/debug/fspid");
const SCENARIO = readFileSync(path("../../crates/fspid-serve/tests/data/all.toml"), "utf8");
const AXE = readFileSync(path("../node_modules/axe-core/axe.min.js"), "utf8");
/** Where pictures of the views are put for people, if somebody wants them. */
const SHOTS = process.env.SHOTS;

let browser, folder, server, address, telemetryPort;
before(async () => {
  browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] });
  folder = mkdtempSync(join(tmpdir(), "fspid-served-"));
  writeFileSync(join(folder, "mine.toml"), SCENARIO);
  telemetryPort = await freePort();
  server = spawn(PROGRAM, ["serve", folder, "--port", "0", "--telemetry", `udp:${telemetryPort}`], { stdio: ["ignore", "pipe", "inherit"] });
  for await (const line of createInterface({ input: server.stdout })) {
    address = /http:\S+/.exec(line)?.[0];
    if (address) break;
  }
  assert.ok(address, "the server says where it is");
});
after(async () => {
  await browser?.close();
  if (server) {
    const ended = new Promise((resolve) => server.once("exit", resolve));
    server.kill("SIGINT");
    assert.equal(await ended, 0, "Ctrl-C is its good end");
  }
  if (folder) rmSync(folder, { recursive: true });
});

/** A port for UDP that nobody has. */
async function freePort() {
  const socket = createSocket("udp4");
  await new Promise((ready) => socket.bind(0, "127.0.0.1", ready));
  const { port } = socket.address();
  await new Promise((ready) => socket.close(ready));
  return port;
}

/** A page on the scenario, at one of its views; whatever goes wrong in it fails the test. */
async function opened(view, options = {}) {
  const page = await browser.newPage({ viewport: { width: 1400, height: 900 }, ...options });
  page.wrong = [];
  page.outside = [];
  page.on("request", (request) => /^https?:/.test(request.url()) && !request.url().startsWith("http://127.0.0.1") && page.outside.push(request.url()));
  page.on("pageerror", (error) => page.wrong.push(error.message));
  page.on("console", (message) => message.type() === "error" && page.wrong.push(message.text()));
  page.setDefaultTimeout(180_000);
  await page.goto(address);
  await page.waitForFunction(() => Number(document.querySelector("#panel")?.dataset.flights) >= 1);
  await page.waitForFunction(() => document.querySelector("[data-test=scenario]").selectedOptions[0]?.text === "mine.toml");
  await page.click(`#tab-${view}`);
  return page;
}

async function closed(page) {
  assert.deepEqual(page.wrong, []);
  assert.deepEqual(page.outside, [], "it asks nobody but its server");
  await page.close();
}

const ended = (page, state) => page.locator(`[data-test=followed][data-state=${state}]`).waitFor({ timeout: 180_000 });
const own = (page) => page.evaluate(async () => {
  document.querySelector("#tab-keep").click();
  await new Promise((resolve) => setTimeout(resolve, 100));
  return document.querySelector("[data-test=text]").value;
});
const shot = async (page, name) => SHOTS && page.screenshot({ path: join(SHOTS, `${name}.png`), fullPage: true });

/** Nothing serious for people with other senses, and nothing cut off. */
async function assertGood(page, what) {
  await page.evaluate(AXE);
  const found = await page.evaluate(() => axe.run(document, { resultTypes: ["violations"] }));
  const serious = found.violations.filter((it) => ["serious", "critical"].includes(it.impact));
  assert.deepEqual(serious.map((it) => `${it.id}: ${it.nodes.map((node) => node.target.join(" ")).join(", ")}`), [], what);
  const [wide, room] = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
  assert.ok(wide <= room, `${what}: ${wide} px in ${room} px`);
}

/** The same in each light and on a phone. */
async function assertGoodEverywhere(page, what) {
  for (const [width, colorScheme] of [[1400, "light"], [390, "dark"], [390, "light"], [1400, "dark"]]) {
    await page.emulateMedia({ colorScheme });
    await page.setViewportSize({ width, height: 900 });
    await page.waitForTimeout(300);
    await shot(page, `${what}-${width}-${colorScheme}`);
    await assertGood(page, `${what}, ${width} px, ${colorScheme}`);
  }
  await page.emulateMedia({ colorScheme: null });
  await page.setViewportSize({ width: 1400, height: 900 });
}

test("a tuning shows its candidates, its best one flies as a guest, and is the person's own only once it is taken over", async () => {
  const page = await opened("many");
  await page.fill("[data-test=budget]", "60");
  await page.click("[data-test=start]");
  await page.locator("[data-test=guest]").waitFor();
  await ended(page, "done");
  assert.match(await page.locator("[data-test=job]").innerText(), /✓ done/);
  assert.equal(await page.locator(".plane").first().locator("circle.sign").count(), 61);
  const costs = page.locator(".plane").first();
  await costs.locator(".reader").focus();
  await page.keyboard.press("Home");
  assert.match(await costs.locator(".reading").innerText(), /^candidate \d+: candidate \d+, cost [\d.]+$/);
  assert.match(await page.locator("[data-test=best]").innerText(), /best: [\d.]+ at candidate \d+: controller\.PID\.kp = /);
  assert.match(await page.locator("[data-test=answer]").innerText(), /PID/);
  await assertGoodEverywhere(page, "tune");
  await page.click("#tab-fly");
  assert.match(await page.locator("[data-test=guest]").innerText(), /best candidate so far of tuning \d+, cost/);
  assert.equal(await own(page), SCENARIO, "the own scenario is as it was");
  assert.equal(await page.locator("[data-test=guest]").count(), 0, "no guest beside the own text");
  await page.click("#tab-many");
  await page.click("[data-test=fly-best]");
  await page.click("[data-test=take-over]");
  await page.locator("[data-test=guest]").waitFor({ state: "detached" });
  assert.match(await own(page), /The best so far of a search/);
  await page.keyboard.press("Escape");
  await page.getByRole("button", { name: "undo" }).click();
  assert.equal(await own(page), SCENARIO);
  await closed(page);
});

test("by keys alone a search for trade-offs is begun, and its front is drawn", async () => {
  const two = SCENARIO.replace("[[tuning.case]]", '[[tuning.objective]]\nmeasure = "largest_command_deg"\n\n[[tuning.case]]');
  writeFileSync(join(folder, "mine.toml"), two);
  const page = await opened("many");
  try {
    await page.locator("[data-test=optimiser]").focus();
    await page.keyboard.type("nsga");
    await page.locator("[data-test=budget]").focus();
    await page.keyboard.type("120");
    await page.keyboard.press("Enter");
    await ended(page, "done");
    const plane = page.locator(".plane", { hasText: "Trade-offs" });
    assert.ok((await plane.locator("circle.series-1").count()) > 3, "more than one trade-off");
    assert.match(await page.locator("#panel").innerText(), /The front has \d+ trade-offs that no other candidate beats/);
    await shot(page, "front");
  } finally {
    writeFileSync(join(folder, "mine.toml"), SCENARIO);
  }
  await closed(page);
});

test("a job that is stopped goes on where it was, and is found again after a reload", async () => {
  const page = await opened("many");
  await page.fill("[data-test=budget]", "5000000");
  await page.click("[data-test=start]");
  await page.locator("[data-test=best]").waitFor();
  await page.reload();
  await page.waitForFunction(() => Number(document.querySelector("#panel")?.dataset.flights) >= 1);
  await page.click("#tab-many");
  await page.locator("[data-test=followed][data-state=running]").waitFor();
  assert.match(await page.locator("[data-test=followed] h3").innerText(), /tune .*budget 5000000/);
  await page.click("[data-test=stop]");
  await ended(page, "cancelled");
  await page.click("[data-test=go-on]");
  await page.getByText(/It goes on after \d+ candidates/).waitFor();
  await page.click("[data-test=stop]");
  await ended(page, "cancelled");
  await page.locator("[data-test=jobs]").waitFor();
  await closed(page);
});

test("a campaign fills histograms and an envelope, and its worst run flies in the flight view", async () => {
  const page = await opened("many");
  await page.selectOption("[data-test=kind]", "campaign");
  await page.fill("[data-test=run-count]", "300");
  await page.click("[data-test=start]");
  await page.locator("[data-distribution=iae_deg_s]").waitFor();
  await ended(page, "done");
  assert.match(await page.locator("[data-test=runs]").innerText(), /All 300 of 300 runs/);
  const bars = page.locator("[data-distribution=iae_deg_s] rect.bar-0");
  // Bin by bin with the arrow keys; each says its ends and how many flights it has.
  const histogram = page.locator("[data-distribution=iae_deg_s]");
  await histogram.locator(".reader").focus();
  const told = [];
  for (let bin = 0; bin < (await bars.count()); bin += 1) {
    await page.keyboard.press(bin ? "ArrowRight" : "Home");
    const [, from, to, count] = /^\S+: ([\d.]+) to ([\d.]+) deg s: (\d+) of 300 flights \([\d.]+ %\)$/.exec(await histogram.locator(".reading").innerText());
    assert.ok(Number(from) < Number(to) && Number(from) >= (told.at(-1)?.to ?? 0));
    told.push({ to: Number(to), count: Number(count) });
  }
  const words = await page.locator("[data-distribution=iae_deg_s] .words li").first().innerText();
  const beyond = Number(/(\d+) beyond the bars/.exec(words)?.[1] ?? 0);
  assert.equal(told.reduce((sum, { count }) => sum + count, 0) + beyond, 300, "every flight is in a bar or told");
  assert.equal(await page.locator("[data-envelope]").count(), 2);
  const bands = page.locator("[data-envelope]").first();
  await bands.locator(".reader").hover();
  assert.match(await bands.locator(".reading").innerText(), /^[\d.]+ s: pitch angle \[deg\] all \S+ to \S+, 5 to 95 % \S+ to \S+, .*median \S+, set-point \S+, run \d+ \S+/);
  assert.match(await page.locator("[data-test=envelope]").innerText(), /first 300 runs, flown again/);
  await assertGoodEverywhere(page, "campaign");
  const worst = page.locator("[data-test=worst] tr", { hasText: "highest iae" }).first();
  const value = Number(/: ([\d.]+)/.exec(await worst.innerText())[1]);
  await worst.getByRole("button").click();
  await page.locator("[data-test=guest]").waitFor();
  assert.match(await page.locator("[data-test=guest]").innerText(), /run \d+ of campaign \d+: setpoint\.amplitude_deg=/);
  const flown = await page.locator('[data-metric="iae"][data-controller="PID"]').getAttribute("data-value").then(Number);
  assert.ok(Math.abs(flown - value) < 1e-3 * value, `${flown} flown, ${value} told`);
  await shot(page, "worst-run");
  await page.click("[data-test=own]");
  await page.locator("[data-test=guest]").waitFor({ state: "detached" });
  assert.equal(await own(page), SCENARIO);
  await closed(page);
});

test("the report of a campaign is saved as a page of its own", async () => {
  const page = await opened("many");
  await page.getByRole("button", { name: /^show campaign/ }).first().click();
  const [download] = await Promise.all([page.waitForEvent("download"), page.click("[data-test=report]")]);
  assert.match(readFileSync(await download.path(), "utf8"), /^<!doctype html>/i);
  await closed(page);
});

test("a proof and a contest tell how far they are and what they found", async () => {
  const page = await opened("many");
  await page.selectOption("[data-test=kind]", "certify");
  await page.selectOption("[data-test=controller]", "slow");
  await page.click("[data-test=start]");
  await ended(page, "done");
  assert.match(await page.locator("[data-test=answer]").innerText(), /slow/);
  const [certificate] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: /^save slow/ }).click()]);
  await page.selectOption("[data-test=kind]", "check");
  await page.setInputFiles("[data-test=certificate]", await certificate.path());
  await page.click("[data-test=start]");
  await page.locator("[data-test=followed] h3", { hasText: "check" }).waitFor();
  await ended(page, "done");
  assert.match(await page.locator("[data-test=answer]").innerText(), /HOLDS, AND IS WHAT FLIES/);
  assert.match(await page.locator("[data-test=followed] h3").innerText(), /^check \d+ on mine\.toml against the scenario$/);
  await shot(page, "check");
  await page.selectOption("[data-test=kind]", "certify");
  await page.selectOption("[data-test=cases]", "tuning");
  await shot(page, "certify-cases");
  await page.click("[data-test=start]");
  await page.locator("[data-test=followed] h3", { hasText: "cases tuning" }).waitFor();
  await ended(page, "done");
  assert.match(await page.locator("[data-test=answer]").innerText(), /slow: PROVED at all \d+ cases of \[tuning\]/);
  await page.selectOption("[data-test=kind]", "contest");
  await page.fill("[data-test=budget]", "8");
  await page.fill("[data-test=seeds]", "1");
  await page.click("[data-test=start]");
  await page.locator("[data-test=followed] h3", { hasText: "contest" }).waitFor();
  await ended(page, "done");
  assert.match(await page.locator("[data-test=answer]").innerText(), /slow/);
  await closed(page);
});

test("a job that cannot be done says why", async () => {
  const page = await opened("many");
  writeFileSync(join(folder, "mine.toml"), SCENARIO.replace("kp = 1.0", "kpp = 1.0"));
  try {
    await page.click("[data-test=start]");
    await ended(page, "failed");
    assert.match(await page.locator("[data-test=job]").innerText(), /✗ failed.*kpp/s);
  } finally {
    writeFileSync(join(folder, "mine.toml"), SCENARIO);
  }
  await closed(page);
});

test("a file that somebody else has changed is not written over", async () => {
  const page = await opened("fly");
  const field = page.locator('[data-path="controller.slow.kp"] input[type=number]');
  await field.fill("1.25");
  await field.press("Enter");
  await page.click("#tab-keep");
  await page.locator(".added").first().waitFor();
  await page.click("[data-test=save]");
  await page.waitForFunction(() => /is saved/.test(document.querySelector("#panel").innerText));
  assert.equal(readFileSync(join(folder, "mine.toml"), "utf8"), SCENARIO.replace("kp = 1.0", "kp = 1.25"));
  writeFileSync(join(folder, "mine.toml"), SCENARIO);
  await page.fill("[data-test=text]", SCENARIO.replace("kp = 1.0", "kp = 1.5"));
  await page.waitForTimeout(600);
  await page.click("[data-test=save]");
  await page.getByText(/has changed on disk/).waitFor();
  assert.equal(readFileSync(join(folder, "mine.toml"), "utf8"), SCENARIO);
  page.wrong = page.wrong.filter((it) => !it.includes("409"));
  await closed(page);
});

/** A loop that answers a step at 1 s with a lag of half a second, `more` deg too high. */
function line(at, more = 0) {
  const time_s = at / 50;
  const setpoint_deg = time_s < 1 ? 0 : 1;
  const measurement_deg = (time_s < 1 ? 0 : 1 - Math.exp(-(time_s - 1) / 0.5)) + more;
  return JSON.stringify({ time_s, setpoint_deg, measurement_deg, command_deg: setpoint_deg - measurement_deg, airspeed_m_s: 200 });
}

/** Sends lines by UDP, some in a packet. */
async function sent(lines) {
  const socket = createSocket("udp4");
  for (let at = 0; at < lines.length; at += 10) {
    await new Promise((done) => socket.send(`${lines.slice(at, at + 10).join("\n")}\n`, telemetryPort, "127.0.0.1", done));
    if (at % 200 === 0) await new Promise((resolve) => setTimeout(resolve, 5));
  }
  socket.close();
}

/** The view of telemetry once the page hears it: what came before is not told to it. */
async function listening() {
  const page = await opened("watch");
  await page.waitForFunction(() => /on port \d/.test(document.querySelector("[data-test=counts]")?.innerText ?? ""));
  return page;
}

const heard = (page, count) => page.waitForFunction((count) => Number(document.querySelector("[data-test=counts]")?.dataset.heard) >= count, count);
const number = (page, name) => page.locator("[data-test=difference]").getAttribute(`data-${name}`).then(Number);

test("Watch: what a loop tells is drawn beside the model that flies with its set-point, with the difference in numbers", async () => {
  const page = await listening();
  await page.getByText("Nothing has come yet").waitFor();
  await sent(Array.from({ length: 250 }, (_, at) => line(at)));
  await heard(page, 250);
  await page.waitForFunction(() => document.querySelector("[data-test=difference]")?.dataset.rms !== undefined);
  await page.waitForTimeout(1200);
  // The same flight by the program.
  const model = await modelled();
  const expected = Array.from({ length: 250 }, (_, at) => JSON.parse(line(at))).map(({ time_s, measurement_deg }) => measurement_deg - model(time_s));
  const rms = Math.sqrt(expected.reduce((sum, it) => sum + it * it, 0) / expected.length);
  const largest = expected.reduce((a, b) => (Math.abs(b) >= Math.abs(a) ? b : a));
  assert.ok(Math.abs((await number(page, "rms")) - rms) < 1e-9, `${await number(page, "rms")} in the page, ${rms} by the program`);
  assert.ok(Math.abs((await number(page, "largest")) - largest) < 1e-9);
  assert.match(await page.locator("#panel").innerText(), /It is no observer/);
  await sent(["nonsense", '{"time_s": "soon"}']);
  await page.waitForFunction(() => document.querySelector("[data-test=counts]").dataset.bad === "2");
  assert.match(await page.locator("[data-test=counts]").innerText(), /2 bad lines.*`time_s` is no number/s);
  await assertGoodEverywhere(page, "watch");
  await closed(page);
});

/** The pitch of the program's own flight with the same set-point, at the samples of the lines. */
async function modelled() {
  const file = join(folder, "model.csv");
  const asked = ["simulate", join(folder, "mine.toml"), "--set", 'setpoint={ kind = "table", time_s = [0.0, 1.0], value_deg = [0.0, 1.0] }', "--set", "loop.duration_s=8", "--trace", file];
  await new Promise((resolve) => spawn(PROGRAM, asked, { stdio: "ignore" }).once("exit", resolve));
  const [head, ...rows] = readFileSync(file, "utf8").trimEnd().split("\n").map((row) => row.split(","));
  rmSync(file);
  const column = head.indexOf("PID.theta_deg");
  return (time_s) => Number(rows[Math.round(time_s / 0.01)][column]);
}

test("Watch: the command of the guide sends a flight, and a model of the same scenario does not differ from it", async () => {
  const guide = readFileSync(path("../../docs/guide/cockpit.md"), "utf8");
  const command = /```sh\n(fspid simulate pitch\.toml --trace - [\s\S]*?)```/.exec(guide)[1];
  const step = path("../../scenarios/747-pitch-step.toml");
  writeFileSync(join(folder, "pitch.toml"), readFileSync(step));
  const page = await listening();
  try {
    await page.selectOption("[data-test=scenario]", { label: "pitch.toml" });
    await page.waitForFunction(() => [...document.querySelectorAll("[data-test=model] option")].some((it) => it.text === "FSPID"));
    // As fast as it comes it would be too fast for UDP.
    const here = command.replace("fspid simulate pitch.toml", `'${PROGRAM}' simulate '${step}'`).replace("14600", telemetryPort).replace("sleep 0.01", "sleep 0.0005");
    const sender = spawn("bash", ["-c", here], { stdio: "inherit" });
    await new Promise((resolve) => sender.once("exit", resolve));
    await heard(page, 1900);
    await page.waitForFunction(() => document.querySelector("[data-test=difference]")?.dataset.rms !== undefined);
    await page.selectOption("[data-test=model]", "FSPID");
    await page.waitForFunction(() => Number(document.querySelector("[data-test=difference]").dataset.largest ?? 1) === 0);
    assert.equal(await number(page, "rms"), 0, "to the bit");
  } finally {
    rmSync(join(folder, "pitch.toml"));
  }
  await closed(page);
});

test("Watch: the picture pauses, a record is saved, a time that goes back is a new flight, and clear forgets all", async () => {
  const page = await listening();
  await page.locator("[data-test=record]").focus();
  await page.keyboard.press("Enter");
  await sent(Array.from({ length: 100 }, (_, at) => line(at, 0.5)));
  await heard(page, 100);
  await page.getByText(/The first line measured 0\.5 deg/).waitFor();
  await page.click("[data-test=pause]");
  await page.waitForTimeout(300);
  const before = await page.locator("[data-test=difference]").innerText();
  await sent(Array.from({ length: 50 }, (_, at) => line(at)));
  await heard(page, 150);
  await page.waitForTimeout(300);
  assert.equal(await page.locator("[data-test=difference]").innerText(), before, "the picture stands still");
  assert.match(await page.locator("[data-test=counts]").innerText(), /flight 2: time went back/);
  const [download] = await Promise.all([page.waitForEvent("download"), page.click("[data-test=record]")]);
  const rows = readFileSync(await download.path(), "utf8").trimEnd().split("\n");
  assert.equal(rows[0].split(",")[0], "time_s");
  assert.equal(rows.length, 151);
  await page.click("[data-test=pause]");
  await page.waitForFunction((before) => document.querySelector("[data-test=difference]").innerText !== before, before);
  await page.click("[data-test=clear]");
  await page.getByText("Nothing has come yet").waitFor();
  await closed(page);
});

test("Watch: lines beyond those that are kept take no more memory", async () => {
  const page = await listening();
  await page.selectOption("[data-test=window]", "0");
  const memory = async () => {
    const session = await page.context().newCDPSession(page);
    await session.send("HeapProfiler.collectGarbage");
    return (await session.send("Runtime.getHeapUsage")).usedSize;
  };
  // UDP may lose some under load: more are sent until so many were heard.
  let at = 0;
  const some = async (count) => {
    while (Number(await page.locator("[data-test=counts]").getAttribute("data-heard")) < count) {
      await sent(Array.from({ length: 1000 }, () => line(at++)));
      await page.waitForTimeout(20);
    }
  };
  const before = await memory();
  await some(75_000);
  const grown = (await memory()) - before;
  assert.ok(grown < 8e6, `${grown} bytes more`);
  await closed(page);
});
