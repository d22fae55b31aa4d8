// The reports of the program in a real browser: figures that are read, enlarged and sorted by mouse and by keys, and that are
// complete without scripts and on paper. Run by `web/test.sh`; CHROMIUM names the browser, FSPID the program.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const path = (name) => fileURLToPath(new URL(name, import.meta.url));
const AXE = readFileSync(path("../node_modules/axe-core/axe.min.js"), "utf8");
const FSPID = process.env.FSPID ?? path("../../target/debug/fspid");
const STEP = path("../../scenarios/747-pitch-step.toml");
/** The reports and the commands that write them, in this order. */
const REPORTS = {
  "flight.html": ["simulate", STEP, "--report", "flight.html", "--trace", "flight.csv"],
  "loop.html": ["analyse", STEP, "--report", "loop.html"],
  "audit.html": ["audit", path("../../examples/systems/tip.toml"), "--report", "audit.html"],
  "run/": ["campaign", "run", path("../../scenarios/campaign.toml"), "--runs", "60", "--quiet", "--out", "run"],
  "campaign.html": ["campaign", "report", "run", "--out", "campaign.html"],
  "paper/report.html": ["reproduce", "--out", "paper"],
};
const PAGES = Object.keys(REPORTS).filter((name) => name.endsWith(".html"));

let browser;
let folder;
before(async () => {
  folder = mkdtempSync(join(tmpdir(), "fspid-reports-"));
  for (const command of Object.values(REPORTS)) execFileSync(FSPID, command, { cwd: folder, stdio: ["ignore", "ignore", "pipe"] });
  browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] });
});
after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

/** A report; whatever goes wrong in it, or is asked for outside, fails the test. */
async function opened(name, options = {}) {
  const page = await browser.newPage({ viewport: { width: 1400, height: 900 }, ...options });
  page.wrong = [];
  page.on("pageerror", (error) => page.wrong.push(error.message));
  page.on("console", (message) => message.type() === "error" && page.wrong.push(message.text()));
  page.on("request", (request) => /^https?:/.test(request.url()) && page.wrong.push(request.url()));
  page.setDefaultTimeout(180_000);
  await page.goto(pathToFileURL(join(folder, name)).href);
  return page;
}
async function close(page) {
  assert.deepEqual(page.wrong, []);
  await page.context().close();
}
/** The place of a panel's point on the screen, by parts of its axes. */
const onScreen = (figure, x, y, panel = 0) =>
  figure.locator("[data-panel]").nth(panel).evaluate((group, [x, y]) => {
    const [left, top, width, height] = group.dataset.panel.split(" ").map(Number);
    group.scrollIntoView({ block: "center" });
    const at = new DOMPoint(left + x * width, top + (1 - y) * height).matrixTransform(group.ownerSVGElement.getScreenCTM());
    return { x: at.x, y: at.y };
  }, [x, y]);
const numbers = (text) => [...text.matchAll(/\u2212?\d+(?:\.\d+)?/g)].map(([number]) => Number(number.replace("\u2212", "-")));

test("the pointer reads every curve with its unit, and as the flight says", async () => {
  const page = await opened("flight.html");
  const figure = page.locator("#responses-figure");
  const at = await onScreen(figure, 0.25, 0.5);
  await page.mouse.move(at.x, at.y);
  const reading = figure.locator(".reading");
  const lines = await reading.locator("p").allInnerTexts();
  assert.match(lines[0], /^time \[s\] 5\.\d+$/);
  assert.match(lines[1], /^pitch angle \[deg\] set-point 1\.\d+ · PC \d.* · CPID \d.* · FSPID \d/);
  const rows = readFileSync(join(folder, "flight.csv"), "utf8").split("\n").map((row) => row.split(","));
  const head = rows[0];
  const column = head.findIndex((name) => name.includes("FSPID") && name.includes("theta"));
  const flown = column < 0 ? rows.filter((row) => row.includes("FSPID")) : rows;
  const theta = column < 0 ? head.findIndex((name) => /theta|pitch/.test(name)) : column;
  const time = head.findIndex((name) => name.startsWith("t"));
  const [time_s] = numbers(lines[0]);
  const row = flown.reduce((best, row) => (Math.abs(Number(row[time]) - time_s) < Math.abs(Number(best[time]) - time_s) ? row : best), flown[1]);
  const read = numbers(lines[1].split("FSPID")[1])[0];
  assert.ok(Math.abs(read - Number(row[theta])) < 0.004, `${read} is read where the flight has ${row[theta]} (${head[theta]})`);
  // No more digits than a drawing of 200 px holds.
  assert.ok(String(read).length <= 6, String(read));
  await close(page);
});

test("a drag enlarges, panels over one time stay together, and the button shows all again", async () => {
  const page = await opened("flight.html");
  const figure = page.locator("#responses-figure");
  const numbersBelow = () => figure.locator('text[text-anchor="middle"]:not([data-axis])').evaluateAll((texts) => texts.filter((text) => !text.closest("[style*=none]")).map((text) => text.textContent));
  const before = await numbersBelow();
  const [from, to] = [await onScreen(figure, 0.1, 0.9), await onScreen(figure, 0.3, 0.4)];
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await page.mouse.move(to.x, to.y, { steps: 5 });
  await page.mouse.up();
  const after = await numbersBelow();
  assert.notDeepEqual(after, before);
  assert.ok(after.length >= 3 && after.every((text) => Number(text) >= 2 && Number(text) <= 6), after.join());
  assert.equal(await figure.locator(".stretched").count(), 3, "panels over one time stay together");
  const middle = await onScreen(figure, 0.5, 0.5, 1);
  await page.mouse.move(middle.x, middle.y);
  const [time_s] = numbers(await figure.locator(".reading p").first().innerText());
  assert.ok(time_s > 3.9 && time_s < 4.1, `${time_s} s in the middle of 2 to 6 s`);
  await figure.getByRole("button", { name: /^Show all/ }).click();
  assert.deepEqual(await numbersBelow(), before);
  await close(page);
});

test("keys alone read, enlarge and reset, and the wheel does once the figure is chosen", async () => {
  const page = await opened("flight.html");
  const figure = page.locator("#responses-figure");
  const drawing = figure.locator(".drawing");
  await drawing.focus();
  await page.keyboard.press("ArrowRight");
  const time = async () => numbers(await figure.locator(".reading p").first().innerText())[0];
  const first = await time();
  await page.keyboard.press("Shift+ArrowRight");
  assert.ok((await time()) > first + 1.5);
  await page.keyboard.press("+");
  assert.ok(await figure.locator("svg[data-enlarged]").count());
  await page.keyboard.press("0");
  assert.equal(await figure.locator("svg[data-enlarged]").count(), 0);
  const at = await onScreen(figure, 0.5, 0.5);
  await page.mouse.move(at.x, at.y);
  await page.mouse.wheel(0, -120);
  await page.waitForFunction(() => document.querySelector("#responses-figure svg[data-enlarged]"));
  await close(page);
});

test("an entry of the legend switches its curve by mouse and by keys, and paper shows all", async () => {
  const page = await opened("flight.html");
  const figure = page.locator("#responses-figure");
  const entry = figure.getByRole("button", { name: "CPID", exact: true });
  const curves = figure.locator('[data-curve][data-name="CPID"]');
  const isShown = () => curves.evaluateAll((all) => all.map((one) => getComputedStyle(one).display !== "none"));
  assert.deepEqual(await isShown(), [true, true, true]);
  await entry.click();
  assert.equal(await entry.getAttribute("aria-pressed"), "false");
  assert.deepEqual(await isShown(), [false, false, false]);
  const at = await onScreen(figure, 0.5, 0.5);
  await page.mouse.move(at.x, at.y);
  assert.doesNotMatch(await figure.locator(".reading").innerText(), /CPID/);
  await entry.focus();
  await page.keyboard.press("Enter");
  assert.deepEqual(await isShown(), [true, true, true]);
  await page.keyboard.press("Space");
  assert.deepEqual(await isShown(), [false, false, false]);
  await page.pdf();
  assert.deepEqual(await isShown(), [true, true, true], "what is printed is complete");
  await close(page);
});

test("a curve that runs to and fro is read at its nearest point", async () => {
  const page = await opened("loop.html");
  const figure = page.locator("#nyquist");
  const at = await figure.locator('[data-curve="0"] path').first().evaluate((line) => {
    line.scrollIntoView({ block: "center" });
    const { x, y } = line.getPointAtLength(line.getTotalLength() / 2).matrixTransform(line.getScreenCTM());
    return { x, y };
  });
  await page.mouse.move(at.x, at.y);
  assert.match(await figure.locator(".reading").innerText(), /imaginary part PC \(.+, .+\)/);
  await close(page);
});

/** The numbers that stand at an axis, as they are shown. */
const ticks = (figure, anchor) =>
  figure.locator(`[data-panel] text[text-anchor="${anchor}"]`).evaluateAll((all) => all.filter((text) => !text.closest("[style*=none]")).map((text) => text.textContent));
async function dragged(page, figure, from, to) {
  const [a, b] = [await onScreen(figure, ...from), await onScreen(figure, ...to)];
  await page.mouse.move(a.x, a.y);
  await page.mouse.down();
  await page.mouse.move(b.x, b.y, { steps: 5 });
  await page.mouse.up();
}

test("Bode, Nyquist and Nichols figures that are enlarged have round ticks, words that can be read, and say what they show", async () => {
  const page = await opened("loop.html");
  const isRound = (text) => /^\u2212?(0|0?\.?0*[1-9]\d?0*|\d+\.\d+|\d+)$/.test(text);
  for (const [id, from, to] of [["bode", [0.3, 0.2], [0.6, 0.9]], ["nyquist", [0.3, 0.3], [0.6, 0.6]], ["nichols", [0.3, 0.3], [0.7, 0.8]]]) {
    const figure = page.locator(`#${id}`);
    const before = [await ticks(figure, "middle"), await ticks(figure, "end")];
    const size = () => figure.locator("[data-of] text").first().evaluate((text) => text.getBoundingClientRect().height);
    const wordsBefore = await size();
    await dragged(page, figure, from, to);
    const after = [await ticks(figure, "middle"), await ticks(figure, "end")];
    assert.notDeepEqual(after, before, id);
    assert.ok(after.every((all) => all.length >= 3 && all.every(isRound)), `${id}: ${after.join(" | ")}`);
    assert.ok(Math.abs((await size()) - wordsBefore) < 1, `${id}: words stay as large as they are`);
    assert.match(await figure.locator(".tools output").innerText(), /^shows \S.* to .*, \S.* to /);
    assert.equal(await figure.locator("svg").getAttribute("viewBox"), await figure.locator("svg").evaluate((svg) => `0 0 ${svg.getAttribute("width")} ${svg.getAttribute("height")}`), "no picture is enlarged");
    await page.keyboard.press("Escape");
    assert.deepEqual([await ticks(figure, "middle"), await ticks(figure, "end")], before, `${id} after Escape`);
    assert.equal(await figure.locator(".tools output").innerText(), "");
    await dragged(page, figure, from, to);
    const middle = await onScreen(figure, 0.5, 0.5);
    await page.mouse.dblclick(middle.x, middle.y);
    assert.deepEqual([await ticks(figure, "middle"), await ticks(figure, "end")], before, `${id} after a double click`);
  }
  await close(page);
});

test("an enlarged curve over a logarithmic axis runs through the values that it is read at", async () => {
  const page = await opened("loop.html");
  const figure = page.locator("#bode");
  await dragged(page, figure, [0.3, 0.2], [0.6, 0.9]);
  const at = await onScreen(figure, 0.5, 0.5);
  await page.mouse.move(at.x, at.y);
  const [mark] = await figure.locator("circle.mark").evaluateAll((all) => all.map((one) => { const box = one.getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; }));
  const away = await figure.locator("[data-curve] path").evaluateAll((all, [x, y]) => Math.min(...all.map((line) => {
    let least = Infinity;
    for (let part = 0; part <= 2000; part += 1) {
      const point = line.getPointAtLength((line.getTotalLength() * part) / 2000).matrixTransform(line.getScreenCTM());
      least = Math.min(least, Math.hypot(point.x - x, point.y - y));
    }
    return least;
  })), mark);
  assert.ok(away < 3, `the mark is ${away} px from every curve`);
  // A tick stands where its number is read, and its first digit is 1, 2 or 5.
  const below = await figure.locator('[data-panel] text[text-anchor="middle"]').evaluateAll((all) =>
    all.filter((text) => !text.closest("[style*=none]")).map((text) => { const box = text.getBoundingClientRect(); return [text.textContent, box.x + box.width / 2]; }));
  assert.ok(below.length >= 3, below.join());
  for (const [text, x] of below) {
    assert.match(text, /^0?\.?0*[125]0*$/);
    await page.mouse.move(x, at.y);
    const [read] = numbers(await figure.locator(".reading p").first().innerText());
    assert.ok(Math.abs(read / Number(text) - 1) < 0.03, `${read} is read at the tick ${text}`);
  }
  await page.mouse.move(at.x, at.y);
  // Both panels have one frequency.
  assert.match(await figure.locator(".reading").innerText(), /frequency \[rad\/s\] 0\.5.*open-loop gain \[dB\] PC .*open-loop phase \[deg\] PC/s);
  await close(page);
});

test("bins, bands, points and cells are read under the pointer and by arrow keys, with their values and words", async () => {
  const page = await opened("campaign.html");
  await page.evaluate(() => document.querySelectorAll("details").forEach((one) => (one.open = true)));
  const read = async (id, x, y) => {
    const figure = page.locator(`#${id}`);
    const at = await onScreen(figure, x, y);
    await page.mouse.move(at.x, at.y);
    return (await figure.locator(".reading").innerText()).replace(/\s+/g, " ");
  };
  const pressed = async (id, key) => {
    await page.locator(`#${id} .drawing`).focus();
    await page.keyboard.press(key);
    return (await page.locator(`#${id} .reading`).innerText()).replace(/\s+/g, " ");
  };
  assert.match(await read("overshoot-pct", 0.3, 0.5), /^overshoot \[%\] [\d.]+ CPID: runs \d+ of 60, [\d.]+ % \([\d.]+ to [\d.]+\) FSPID: runs \d+ of 60/);
  const [first, second] = [await pressed("overshoot-pct", "ArrowRight"), await pressed("overshoot-pct", "ArrowRight")];
  assert.notEqual(first, second, "an arrow leads to the next bin");
  assert.match(await read("responses-pitch", 0.2, 0.5), /^time \[s\] 10\.0 CPID: pitch angle \[deg\] all [\d.]+ to [\d.]+ · 5 to 95 % [\d.]+ to .* median [\d.]+ .*FSPID: pitch angle/);
  assert.match(await pressed("runs-0", "ArrowRight"), /^short_period_stiffness [\d.]+ short_period_damping [\d.]+ run \d+ \S/);
  const [stiffness, damping, run] = numbers(await pressed("runs-0", "ArrowRight"));
  const { parameters } = JSON.parse(execFileSync(FSPID, ["campaign", "replay", "run", "--run", String(run), "--format", "json"], { cwd: folder, encoding: "utf8" }));
  assert.ok(Math.abs(parameters.short_period_stiffness - stiffness) < 0.002 && Math.abs(parameters.short_period_damping - damping) < 0.003, `run ${run} is read at ${stiffness}, ${damping}`);
  assert.match(await read("map-0-0", 0.3, 0.3), /^short_period_stiffness [\d.]+ to [\d.]+ short_period_damping [\d.]+ to [\d.]+ .* \d+ of \d+, [\d.]+ %$/);
  assert.equal(await page.locator("#map-0-0 .tools button").count(), 0, "what is not enlarged has no buttons for it");
  await close(page);
  const loop = await opened("loop.html");
  const map = loop.locator("#frozen-fspid-phase-margin");
  const at = await onScreen(map, 0.4, 0.4);
  await loop.mouse.move(at.x, at.y);
  assert.match((await map.locator(".reading").innerText()).replace(/\s+/g, " "), /^change of error \[supervisor units\] \u22121\.25 error \[supervisor units\] \u22121\.25 phase margin \[deg\] \d+, less than required$/);
  await close(loop);
});

test("without scripts a report is complete, and has no buttons that do nothing", async () => {
  const page = await opened("flight.html", { javaScriptEnabled: false });
  assert.equal(await page.locator("button").count(), 0);
  assert.ok((await page.locator("figure svg [data-curve] path").count()) > 6);
  await close(page);
});

test("every report fits a phone and uses a wide screen, where figures stand in two columns", async () => {
  for (const name of PAGES) {
    const phone = await opened(name, { viewport: { width: 390, height: 844 }, colorScheme: "dark" });
    const cut = await phone.evaluate(() => {
      const boxes = [...document.querySelectorAll("body *")].filter((one) => !one.closest(".scroll, .drawing, pre, svg, .skip, details:not([open])"));
      return boxes.filter((one) => one.getBoundingClientRect().right > innerWidth + 1).map((one) => one.outerHTML.slice(0, 80));
    });
    assert.deepEqual(cut, [], name);
    assert.equal(await phone.evaluate(() => document.documentElement.scrollWidth), 390, name);
    await close(phone);
    const wide = await opened(name);
    const places = await wide.locator("figure").evaluateAll((all) => all.map((one) => one.getBoundingClientRect()).map(({ left, right, width }) => ({ left, right, width })));
    assert.ok(places.some(({ right }) => right > 1100), `${name}: figures end in the left half`);
    await close(wide);
  }
});

test("what is folded on a page is printed, and folded again after it", async () => {
  const page = await opened("campaign.html");
  const folded = () => page.locator("details").evaluateAll((all) => all.filter((one) => !one.open).length);
  const before = await folded();
  assert.ok(before > 0);
  await page.evaluate(() => addEventListener("beforeprint", () => (window.folded = document.querySelectorAll("details:not([open])").length)));
  await page.pdf();
  assert.equal(await page.evaluate(() => window.folded), 0);
  assert.equal(await folded(), before);
  await close(page);
});

test("the report of the paper prints on at most 25 pages", async () => {
  const page = await opened("paper/report.html");
  const pdf = (await page.pdf({ preferCSSPageSize: true })).toString("latin1");
  const pages = pdf.match(/\/Type\s*\/Page[^s]/g).length;
  assert.ok(pages <= 25, `${pages} pages`);
  await close(page);
});

test("axe has no serious finding in any report", async () => {
  for (const name of PAGES) {
    const page = await opened(name);
    await page.evaluate(AXE);
    const found = await page.evaluate(() => globalThis.axe.run(document, { resultTypes: ["violations"] }));
    const serious = found.violations.filter(({ impact }) => impact === "serious" || impact === "critical");
    assert.deepEqual(serious.map(({ id, nodes }) => [id, nodes.length, nodes[0].html.slice(0, 200)]), [], name);
    await close(page);
  }
});
