// What a screen reader says of the page and of reports, read off the tree that the browser gives it (Chromium's accessibility
// tree): verdicts, tables, live regions, figures. SPOKEN=write stores the walk that a person can read in `spoken/fly.txt`
// anew. Run by `web/test.sh`; CHROMIUM names the browser, FSPID the program.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const path = (name) => fileURLToPath(new URL(name, import.meta.url));
const PAGE = pathToFileURL(path("../dist/page.html")).href;
const FSPID = process.env.FSPID ?? path("../../target/debug/fspid");
const STEP = path("../../scenarios/747-pitch-step.toml");
const WALK = path("spoken/fly.txt");
const KP = "controller.FSPID.nominal.kp";

let browser;
let page;
before(async () => {
  browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] });
  page = await browser.newPage({ viewport: { width: 1400, height: 900 } });
  page.setDefaultTimeout(180_000);
  await page.goto(PAGE);
  await page.waitForFunction(() => Number(document.querySelector("#panel")?.dataset.flights) >= 1);
});
after(() => browser?.close());

const LEAVES = ["StaticText", "InlineTextBox", "LineBreak"];

/** The accessible nodes below an element, each with its role, name and children; what is ignored gives way to its children. */
async function tree(page, selector) {
  const session = await page.context().newCDPSession(page);
  const { root } = await session.send("DOM.getDocument", { depth: 0 });
  const { nodeId } = await session.send("DOM.querySelector", { nodeId: root.nodeId, selector });
  const { node } = await session.send("DOM.describeNode", { nodeId });
  const { nodes } = await session.send("Accessibility.getFullAXTree");
  await session.detach();
  const known = new Map(nodes.map((it) => [it.nodeId, it]));
  const made = (id) => {
    const it = known.get(id);
    if (!it) return [];
    const children = (it.childIds ?? []).flatMap(made);
    if (it.ignored) return children;
    const property = (name) => it.properties?.find((one) => one.name === name)?.value?.value;
    return [{ role: it.role.value, name: it.name?.value ?? "", value: it.value?.value, description: it.description?.value, live: property("live"), pressed: property("pressed"), children }];
  };
  const found = nodes.find((it) => it.backendDOMNodeId === node.backendNodeId);
  return made(found.nodeId);
}

const words = (node) => (LEAVES.includes(node.role) ? [node.name] : node.name && !node.children.length ? [node.name] : node.children.flatMap(words));
const said = (node) => (node.name || words(node).join(" ")).replace(/\s+/g, " ").trim();
const all = (nodes, role) => nodes.flatMap((it) => [...(it.role === role ? [it] : []), ...all(it.children, role)]);
const ROWS = ["columnheader", "rowheader", "cell", "gridcell"];

/** What is heard of a table, cell by cell: its row, its column, its content. */
function spokenTable(table) {
  const rows = all([table], "row").map((row) => row.children.filter(({ role }) => ROWS.includes(role)));
  const columns = rows[0].map(said);
  const cells = rows.slice(1).flatMap((row) => {
    const head = row.find(({ role }) => role === "rowheader");
    return row.flatMap((cell, n) => (cell === head ? [] : [[head && said(head), columns[n], said(cell)].filter(Boolean).join(", ")]));
  });
  return { columns, cells };
}

test("verdicts are heard with their word and sign, tables with the heads of row and column, charts with what they show", async () => {
  const [metrics] = await tree(page, "table.metrics");
  const [chart] = await tree(page, "figure.chart");
  const heard = [...(await page.locator(".verdicts").ariaSnapshot()).matchAll(/- paragraph: "(.*)"/g)].map(([, text]) => text);
  assert.equal(heard.length, 3);
  for (const line of heard) assert.match(line, /^(good|to be looked at|bad): (PC|CPID|FSPID) \S+/);
  const { columns, cells } = spokenTable(metrics);
  assert.deepEqual(columns, ["measure", "PC", "CPID", "FSPID"]);
  assert.ok(cells.some((cell) => /^rise time \[s\], FSPID, \d/.test(cell)), cells.join("; "));
  assert.ok(cells.every((cell) => cell.split(", ").length >= 3), "each cell has both heads and a content");
  const [plot] = all([chart], "application");
  assert.match(plot.name, /^Pitch: pitch angle \[deg\] over time \[s\]\. Arrow keys/);
  const walk = [
    "What is heard of the flight view of the first scenario, from the tree that Chromium gives to screen readers.", "",
    "The verdicts, each a paragraph:", ...heard.map((it) => `  ${it}`), "",
    `A table: ${metrics.name}. Each cell with its row and its column:`, ...cells.map((it) => `  ${it}`), "",
    `A chart: ${plot.name}`, ...all([chart], "button").map((it) => `  button, ${it.pressed === "true" ? "pressed" : "not pressed"}: ${it.name}`), "",
  ].join("\n");
  if (process.env.SPOKEN === "write") {
    mkdirSync(dirname(WALK), { recursive: true });
    writeFileSync(WALK, walk);
  }
  assert.equal(walk, readFileSync(WALK, "utf8"), "SPOKEN=write stores the walk anew, to be read");
});

test("a slider that is moved is told with its value, and the new verdicts are spoken once when it rests", async () => {
  await page.waitForFunction(() => /FSPID: good/.test(document.querySelector("[data-test=spoken]").textContent));
  assert.equal(await page.locator(".verdicts[aria-live]").count(), 0, "what is redrawn at every frame is not spoken");
  await page.evaluate(() => {
    globalThis.spoken = [];
    new MutationObserver(() => globalThis.spoken.push(document.querySelector("[data-test=spoken]").textContent)).observe(document.querySelector("[data-test=spoken]"), { childList: true, characterData: true, subtree: true });
  });
  const slider = page.locator(`[data-path="${KP}"] input[type=range]`);
  await slider.focus();
  const before = await page.locator("#panel").getAttribute("data-flights").then(Number);
  for (let times = 0; times < 12; times += 1) {
    await page.keyboard.press("ArrowRight");
    await page.waitForTimeout(40);
  }
  await page.waitForFunction(() => globalThis.spoken.length > 0);
  await page.waitForTimeout(900);
  const spoken = await page.evaluate(() => globalThis.spoken);
  assert.equal(spoken.length, 1, spoken.join(" | "));
  assert.match(spoken[0], /PC: (good|to be looked at|bad), .+\. CPID: .+\. FSPID: (good|to be looked at|bad), \w+.*, overshoot \[%\] \d/);
  assert.ok((await page.locator("#panel").getAttribute("data-flights").then(Number)) > before + 1, "it flew several times meanwhile");
  const [told] = await tree(page, `[data-path="${KP}"] input[type=range]`);
  assert.equal(told.role, "slider");
  assert.match(told.name, /^kp, controller\.FSPID\.nominal\.kp$/);
  await page.keyboard.press("Control+z");
});

test("a chart speaks what is under its cursor, and of charts that move together one alone speaks", async () => {
  const plot = page.locator("figure.chart .plot").first();
  await plot.focus();
  for (let times = 0; times < 3; times += 1) await page.keyboard.press("ArrowRight");
  const live = page.locator("figure.chart .readout[aria-live=polite]");
  assert.equal(await live.count(), 1);
  assert.match((await live.textContent()).replace(/\s+/g, " "), /time \[s\] 0\.0\d+, pitch angle \[deg\]: set-point \d.*PC .*CPID .*FSPID/);
  await page.mouse.move(700, 400);
  await page.locator("h1").click();
  assert.equal(await live.count(), 0, "what a pointer moves over is not spoken");
});

test("the cells of the rule grid are heard with their row, column and label, and Nyquist's curve with its frequency", async () => {
  await page.click("#tab-shape");
  await page.locator('[data-cell="2-4"]').first().waitFor();
  const [grid] = await tree(page, "table[role=grid]");
  const cells = all([grid], "button").map(said);
  assert.equal(cells.length, 49);
  assert.match(cells[2 * 7 + 4], /^error NS, change PS: [NPZ]\w;.* the strongest of \d+ samples/);
  const map = page.locator(".surface .reader");
  await map.focus();
  await page.keyboard.press("End");
  assert.match(await page.locator(".surface .reading[aria-live=polite]").textContent(), /error .*\d.*, change .*\d: Δkp \S+/);
  await page.click("#tab-judge");
  const nyquist = page.getByRole("application", { name: /^Nyquist: imaginary part over real part\. Arrow keys read it/ });
  await nyquist.focus();
  await page.keyboard.press("Home");
  await page.keyboard.press("ArrowRight");
  assert.match(await page.locator(".plane .reading[aria-live=polite]").first().textContent(), /^PC at [\d.]+ rad\/s: real part \S+, imaginary part \S+/);
  await page.click("#tab-fly");
});

test("every figure of a report has a name and a summary, and its tables have heads", async () => {
  const folder = mkdtempSync(join(tmpdir(), "fspid-spoken-"));
  try {
    for (const [name, command] of [["loop.html", "analyse"], ["flight.html", "simulate"]]) {
      execFileSync(FSPID, [command, STEP, "--report", join(folder, name)], { stdio: ["ignore", "ignore", "pipe"] });
      const report = await browser.newPage();
      await report.goto(pathToFileURL(join(folder, name)).href);
      const main = await tree(report, "main");
      const figures = all(main, "group").filter((it) => /Arrow keys move the reading/.test(it.name));
      const drawings = await report.locator("figure svg[viewBox]").count();
      const pictures = await report.locator("figure svg[viewBox]").evaluateAll((list) =>
        list.map((svg) => [svg.querySelector("title").textContent, svg.querySelector("desc").textContent, svg.getAttribute("aria-labelledby").split(" ").every((id) => document.getElementById(id))]));
      assert.ok(drawings > 3 && figures.length > 3, `${name}: ${figures.length} of ${drawings} can be read by keys`);
      for (const [title, summary, isKnown] of pictures) assert.ok(title.length > 3 && summary.length > 20 && isKnown, `${name}: ${title}: ${summary}`);
      const { columns, cells } = spokenTable(all(main, "table")[0]);
      assert.ok(columns.every(Boolean) && cells.length && cells.every((cell) => cell.includes(", ")), `${name}: ${columns.join()}`);
      await report.close();
    }
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
});
