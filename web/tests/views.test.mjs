// The page in a real browser, each view by mouse and by keys. Run by `web/test.sh`; CHROMIUM names the browser.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const path = (name) => fileURLToPath(new URL(name, import.meta.url));
const PAGE = pathToFileURL(path("../dist/page.html")).href;
const STEP = readFileSync(path("../../scenarios/747-pitch-step.toml"), "utf8");
const AXE = readFileSync(path("../node_modules/axe-core/axe.min.js"), "utf8");
const VIEWS = ["fly", "shape", "judge", "explain", "many", "watch", "keep"];
const KP = "controller.FSPID.nominal.kp";

let browser;
before(async () => (browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] })));
after(() => browser?.close());

/** A page that has flown; whatever goes wrong in it fails the test. */
async function opened(options = {}, address = PAGE) {
  const page = await browser.newPage({ viewport: { width: 1400, height: 900 }, ...options });
  page.wrong = [];
  page.outside = [];
  page.on("pageerror", (error) => page.wrong.push(error.message));
  page.on("console", (message) => message.type() === "error" && page.wrong.push(message.text()));
  page.on("request", (request) => /^https?:/.test(request.url()) && page.outside.push(request.url()));
  page.setDefaultTimeout(180_000);
  await page.goto(address);
  await flown(page, 1);
  return page;
}

const flights = (page) => page.locator("#panel").getAttribute("data-flights").then(Number);
const flown = (page, count) => page.waitForFunction((count) => Number(document.querySelector("#panel")?.dataset.flights) >= count, count);
/** Every value that was moved is in the text: what is asked from here on is of the last of them. */
const settled = (page) => page.waitForFunction(() => document.querySelector("#panel")?.dataset.moving === "0");
const metric = (page, name, controller) => page.locator(`[data-metric="${name}"][data-controller="${controller}"]`).getAttribute("data-value").then(Number);
const text = async (page) => {
  await settled(page);
  await page.click("#tab-keep");
  return page.inputValue("[data-test=text]");
};
const close = async (page) => {
  assert.deepEqual(page.wrong, []);
  await page.close();
};

test("the page opens from disk, flies a scenario, and asks nobody outside", async () => {
  const page = await opened();
  assert.match(await page.locator(".verdict[data-controller=FSPID]").innerText(), /✓.*FSPID.*settled/s);
  assert.ok((await page.locator(".chart canvas").count()) >= 6);
  assert.deepEqual(page.outside, []);
  await close(page);
});

test("Fly: a slider that is dragged moves the measures, and undo brings them back to the bit", async () => {
  const page = await opened();
  const before = await metric(page, "overshoot_pct", "FSPID");
  const slider = page.locator(`[data-path="${KP}"] input[type=range]`);
  await slider.scrollIntoViewIfNeeded();
  const box = await slider.boundingBox();
  await page.mouse.move(box.x + box.width * 0.66, box.y + box.height / 2);
  await page.mouse.down();
  for (const part of [0.7, 0.8, 0.9]) await page.mouse.move(box.x + box.width * part, box.y + box.height / 2, { steps: 4 });
  await page.mouse.up();
  await page.waitForFunction(([name, value]) => Number(document.querySelector(`[data-metric="${name}"][data-controller="FSPID"]`)?.dataset.value) !== value, ["overshoot_pct", before]);
  await settled(page);
  await page.keyboard.press("Control+z");
  await page.waitForFunction(([name, value]) => Number(document.querySelector(`[data-metric="${name}"][data-controller="FSPID"]`)?.dataset.value) === value, ["overshoot_pct", before]);
  assert.ok(await page.getByRole("button", { name: "undo" }).isDisabled(), "a drag is one step");
  await close(page);
});

test("Fly: by keys alone a slider moves, a field takes a number, and a curve tells its values", async () => {
  const page = await opened();
  await page.locator(`[data-path="${KP}"] input[type=range]`).focus();
  const count = await flights(page);
  await page.keyboard.press("ArrowRight");
  await flown(page, count + 1);
  const field = page.locator(`[data-path="${KP}"] input[type=number]`);
  await field.focus();
  await page.keyboard.press("Control+a");
  await page.keyboard.type("2.5");
  await page.keyboard.press("Enter");
  await flown(page, count + 2);
  const plot = page.locator(".plot").first();
  await plot.focus();
  await page.keyboard.press("End");
  assert.match(await page.locator(".readout").first().innerText(), /^time \[s\]\s+20\s.*pitch angle \[deg\]\s*: .*FSPID \S/s);
  assert.match(await text(page), /nominal = \{ kp = 2\.5, ki = 0\.5, kd = 1\.0 \}/);
  await close(page);
});

test("Fly: a pinned run stays beside the new one, and a line is hidden by its button", async () => {
  const page = await opened();
  await page.click("[data-test=pin]");
  await page.getByRole("button", { name: "CPID, pinned" }).first().waitFor();
  const line = page.getByRole("button", { name: "CPID", exact: true }).first();
  await line.click();
  assert.equal(await line.getAttribute("aria-pressed"), "false");
  await close(page);
});

test("Shape: a rule is another one after a letter, after a click, and what it was after undo", async () => {
  const page = await opened();
  await page.click("#tab-shape");
  const grid = page.getByRole("grid", { name: "rules for Δkp" });
  const cell = grid.locator('[data-cell="3-3"]');
  await cell.focus();
  assert.equal(await cell.innerText(), "ZO");
  await page.keyboard.press("p");
  await page.waitForFunction(() => document.querySelector('[data-cell="3-3"]').innerText === "PS");
  await page.keyboard.press("ArrowDown");
  assert.equal(await page.evaluate(() => document.activeElement.dataset.cell), "4-3");
  await grid.locator('[data-cell="3-4"]').click();
  await page.locator(".labels").first().getByRole("button", { name: "PB" }).click();
  await page.waitForFunction(() => document.querySelector('[data-cell="3-4"]').innerText === "PB");
  assert.match(await text(page), /PM PM PS PS PB NM NM/);
  await page.locator("h1").click();
  await page.keyboard.press("Control+z");
  await page.keyboard.press("Control+z");
  await page.waitForFunction((text) => document.querySelector("[data-test=text]").value === text, STEP);
  await close(page);
});

test("Shape: the centre of a set is dragged by mouse and moved by keys", async () => {
  const page = await opened();
  await page.click("#tab-shape");
  const handle = page.locator('[data-handle="error-PS"]');
  await handle.scrollIntoViewIfNeeded();
  const box = await handle.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + 30, box.y + box.height / 2, { steps: 5 });
  await page.mouse.up();
  await page.waitForFunction(() => Number(document.querySelector('[data-handle="error-PS"]').getAttribute("aria-valuenow")) > 0.36);
  await page.locator('[data-handle="change-PM"]').focus();
  await page.keyboard.press("ArrowRight");
  await page.waitForFunction(() => Number(document.querySelector('[data-handle="change-PM"]').getAttribute("aria-valuenow")) > 0.67);
  const found = await text(page);
  assert.match(found, /error_set_centres = \[0\.\d+, 0\.66\d\]/);
  assert.match(found, /change_set_centres = \[0\.333, 0\.67\d\]/);
  await close(page);
});

test("Judge: margins move with a slider, a ready set is judged, and a fixed controller is certified", async () => {
  const page = await opened();
  await page.locator("#tab-fly").focus();
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowRight");
  const row = page.locator("[data-test=margins] tr", { hasText: "CPID" });
  await row.waitFor();
  const before = await row.innerText();
  assert.match(before, /✓ stable/);
  await page.locator('[data-path="controller.CPID.kp"] input[type=range]').focus();
  for (let times = 0; times < 20; times += 1) await page.keyboard.press("ArrowRight");
  await page.waitForFunction((before) => ![...document.querySelectorAll("[data-test=margins] tr")].some((it) => it.innerText === before), before);
  await settled(page);
  await page.getByRole("button", { name: "map of frozen gains" }).click();
  assert.match(await page.locator(".frozen figcaption").innerText(), /✓ stable at all 81 points/);
  await page.locator(`[data-path="${KP}"] input[type=range]`).focus();
  await page.keyboard.press("ArrowRight");
  await page.locator("[data-test=old-map]").waitFor();
  assert.equal(await page.locator(".frozen").count(), 0, "a map of other gains is not shown");
  await page.getByLabel("mil-f-9490d").check();
  await page.locator(".requirements td.good").first().waitFor();
  assert.ok((await page.locator(".requirements td.bad").count()) > 0);
  await page.getByRole("button", { name: "certify CPID" }).click();
  await page.locator("[data-test=certified] .verdict").waitFor({ timeout: 180_000 });
  assert.match(await page.locator("[data-test=certified]").innerText(), /PROVED|REFUTED|OPEN/);
  await close(page);
});

test("Explain: a click in a curve tells the parts of the command there and the rules that fired; keys move on", async () => {
  const page = await opened();
  const box = await page.locator(".chart .u-over").first().boundingBox();
  await page.mouse.click(box.x + box.width * 0.05, box.y + box.height / 2);
  await page.locator("[data-test=parts]").waitFor();
  assert.match(await page.locator("[data-test=parts] caption").innerText(), /FSPID at (0\.9|1)/);
  assert.ok((await page.locator("[data-test=fired] tbody tr").count()) > 1);
  const caption = await page.locator("[data-test=parts] caption").innerText();
  await page.locator("[data-test=instant]").focus();
  await page.keyboard.press("ArrowRight");
  await page.waitForFunction((before) => document.querySelector("[data-test=parts] caption").innerText !== before, caption);
  await close(page);
});

test("Keep: the difference is shown, the command sets what differs, and the file that is saved keeps its comments", async () => {
  const page = await opened();
  const field = page.locator(`[data-path="${KP}"] input[type=number]`);
  await field.fill("2.25");
  await field.press("Enter");
  await page.click("#tab-keep");
  await page.locator(".added").waitFor();
  assert.match(await page.locator("[data-test=difference]").innerText(), /\+ nominal = \{ kp = 2\.25/);
  await page.waitForFunction(() => document.querySelector("[data-test=command]").innerText.includes("kp=2.25"));
  const [download] = await Promise.all([page.waitForEvent("download"), page.click("[data-test=save]")]);
  const saved = readFileSync(await download.path(), "utf8");
  assert.equal(saved, STEP.replace("nominal = { kp = 2.0", "nominal = { kp = 2.25"));
  const [figure] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "save Nyquist as SVG" }).click()]);
  assert.match(readFileSync(await figure.path(), "utf8"), /^<svg/);
  const [pixels] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "save time responses as PNG" }).click()]);
  assert.equal(readFileSync(await pixels.path()).subarray(1, 4).toString(), "PNG");
  await close(page);
});

test("an interval is shown on its slider, by click and by key, and is of the old text as soon as the text changes", async () => {
  const page = await opened();
  const number = page.locator(`[data-path="${KP}"]`);
  const slider = number.locator("input[type=range]");
  await number.getByRole("button", { name: /in which interval does kp hold/ }).click();
  const told = number.locator("[data-test=holds]");
  await told.locator("summary").waitFor();
  const [, count, least, most] = (await told.innerText()).match(/✓ holds at all (\d+) values looked at between ([\d.]+) and ([\d.]+)/);
  assert.ok(Number(count) > 20 && Number(least) < 2 && Number(most) > 2, `${count} between ${least} and ${most}`);
  await told.locator("summary").click();
  assert.match(await told.innerText(), /what lies between them was not looked at.*Below: at [\d.]+ FSPID: not settled.*Above: at/s);
  // The band is where the slider has these values.
  const [min, max] = await slider.evaluate((it) => [Number(it.min), Number(it.max)]);
  const box = await number.locator(".band").boundingBox();
  const inside = await number.locator(".band .inside").boundingBox();
  assert.ok(Math.abs((inside.x - box.x) / box.width - (Number(least) - min) / (max - min)) < 0.02);
  assert.ok(Math.abs((inside.x + inside.width - box.x) / box.width - Math.min(1, (Number(most) - min) / (max - min))) < 0.02);
  await slider.focus();
  await page.keyboard.press("ArrowRight");
  await number.locator(".band.old").waitFor();
  assert.match(await told.innerText(), /before it changed; ask again/);
  await page.keyboard.press("i");
  await told.locator("summary").waitFor();
  assert.equal(await number.locator(".band.old").count(), 0);
  // Ready sets that are ticked are asked too.
  await page.click("#tab-judge");
  await page.getByRole("checkbox", { name: "ctms" }).check();
  await number.locator(".band.old").waitFor();
  await number.getByRole("button", { name: /in which interval does kp hold/ }).click();
  await told.locator("summary").waitFor();
  assert.match(await told.locator("p").textContent(), /requirements?, with ctms/);
  await close(page);
});

test("all intervals are looked at one after the other, stop at a word, and a change ends them", async () => {
  const page = await opened();
  const answers = page.locator("[data-test=holds] summary, [data-test=holds] .bad");
  await page.click("[data-test=all-intervals]");
  await answers.nth(2).waitFor();
  await page.click("[data-test=stop-intervals]");
  await page.locator("[data-test=all-intervals]").waitFor();
  const count = await answers.count();
  assert.ok(count >= 3 && count < 40, `${count}`);
  assert.match(await page.locator('[data-path="controller.PC.kp"] [data-test=holds]').innerText(), /✗ does not hold at 3.5287; [\d.]+ does/);
  await page.click("[data-test=all-intervals]");
  await page.locator("[data-test=stop-intervals]").waitFor();
  const field = page.locator(`[data-path="${KP}"] input[type=number]`);
  await field.fill("2.25");
  await field.press("Enter");
  await page.locator("[data-test=all-intervals]").waitFor();
  const all = Number(/all (\d+) hold/.exec(await page.locator("[data-test=all-intervals]").innerText())[1]);
  assert.ok((await page.locator("[data-test=holds]").count()) < all, "what was not looked at yet is not looked at any more");
  await page.locator(".band.old").first().waitFor();
  await close(page);
});

test("Shape: a step that goes the wrong way is marked at once, with a sign and in words, and the marks can be hidden", async () => {
  const page = await opened();
  await page.click("#tab-shape");
  const grid = page.getByRole("grid", { name: "rules for Δkp" });
  const words = page.locator("[data-audit=delta_kp]");
  await words.waitFor();
  assert.match(await words.innerText(), /each of the 49 cells has a rule; falls along error without exception/);
  assert.equal(await grid.locator(".turned").count(), 0);
  await grid.locator('[data-cell="3-3"]').focus();
  await page.keyboard.press("n");
  await page.keyboard.press("n");
  await grid.locator(".turned").first().waitFor();
  await page.waitForFunction(() => /but for \d of 42 steps/.test(document.querySelector("[data-audit=delta_kp]").innerText));
  const marked = grid.locator('td:has(.turned.below) button').first();
  assert.match(await marked.getAttribute("aria-label"), /to error \w\w it goes the other way than most/);
  await page.locator("[data-test=marks]").uncheck();
  assert.equal(await grid.locator(".turned").count(), 0);
  await close(page);
});

test("Shape: the surface turns by drag, by arrows and by two numbers, and is drawn anew", async () => {
  const page = await opened();
  await page.click("#tab-shape");
  const seen = (told) => page.locator(`.surface[data-seen="${told}"]`).waitFor();
  const drawn = () => page.locator("[data-test=turn] img").getAttribute("src");
  await seen("view-kp -60 26");
  const before = await drawn();
  const turn = page.locator("[data-test=turn]");
  await turn.scrollIntoViewIfNeeded();
  const box = await turn.boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 40, y + 20, { steps: 6 });
  await page.mouse.up();
  await seen("view-kp -80 36");
  assert.notEqual(await drawn(), before);
  await turn.focus();
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Shift+ArrowUp");
  await seen("view-kp -85 37");
  await page.locator("[data-test=azimuth]").fill("120");
  await page.keyboard.press("Tab");
  await page.locator("[data-test=elevation]").fill("95");
  await page.keyboard.press("Tab");
  await seen("view-kp 120 90");
  await turn.focus();
  await page.keyboard.press("Home");
  await seen("view-kp -60 26");
  assert.equal(await drawn(), before);
  await close(page);
});

/** Puts the pointer on a part of a box. */
async function hovered(page, locator, x, y) {
  await locator.scrollIntoViewIfNeeded();
  const box = await locator.boundingBox();
  await page.mouse.move(box.x + x * box.width, box.y + y * box.height);
}

test("planes, maps and surfaces are read under the pointer and by arrow keys", async () => {
  const page = await opened();
  await page.click("#tab-judge");
  await page.getByRole("button", { name: "map of frozen gains" }).click();
  const map = page.getByRole("grid", { name: "frozen gains of FSPID" });
  await map.waitFor();
  await map.locator("td[data-told]").nth(40).hover();
  const told = page.locator(".frozen .reading");
  assert.match(await told.innerText(), /^error 0, change 0: stable, phase margin \d+ deg; kp [\d.]+, ki [\d.]+, kd [\d.]+$/);
  await map.locator("td[data-told]").first().focus();
  await page.keyboard.press("ArrowDown");
  await page.keyboard.press("ArrowRight");
  assert.match(await told.innerText(), /^error 3\.75, change \u22123\.75: stable/);
  const nichols = page.locator(".plane", { hasText: "Nichols" });
  const [x, y] = await nichols.locator("path.curve").first().evaluate((line) => {
    line.scrollIntoView({ block: "center" });
    const at = line.getPointAtLength(line.getTotalLength() / 2).matrixTransform(line.getScreenCTM());
    return [at.x, at.y];
  });
  await page.mouse.move(x, y);
  assert.match(await nichols.locator(".reading").innerText(), /^PC at [\d.]+ rad\/s: phase \[deg\] \u2212[\d.]+, gain \[dB\] \S+$/);
  await page.click("#tab-shape");
  const surface = page.locator(".surface .reader");
  await surface.waitFor();
  await hovered(page, surface, 0.35, 0.5);
  const value = await page.locator(".surface .reading").innerText();
  assert.match(value, /^error .* \S+, change of error .* \S+: Δkp \S+$/);
  await surface.focus();
  await page.keyboard.press("Home");
  assert.match(await page.locator(".surface .reading").innerText(), /^error \S+ \u22125, change of error \S+ \u22125: Δkp [\d.]+$/);
  await page.keyboard.press("ArrowUp");
  assert.match(await page.locator(".surface .reading").innerText(), /^error \S+ \u22124\.\d+, change of error \S+ \u22125:/);
  await close(page);
});

test("Keep: there is a command for every target of an export, with what was changed and not saved", async () => {
  const page = await opened();
  const field = page.locator(`[data-path="${KP}"] input[type=number]`);
  await field.fill("2.25");
  await field.press("Enter");
  await page.click("#tab-keep");
  await page.waitForFunction(() => document.querySelector('[data-export="c"]')?.innerText.includes("kp=2.25"));
  assert.match(await page.locator("[data-export=c]").innerText(), /^fspid export 747-pitch-step.toml --controller FSPID --to c --out fspid-c --set /);
  assert.equal(await page.locator("[data-export]").count(), 9);
  const [code] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "save c", exact: true }).click()]);
  assert.equal(code.suggestedFilename(), "fspid-c.zip");
  const archive = readFileSync(await code.path());
  assert.equal(archive.readUInt32LE(0), 0x04034b50);
  assert.ok(archive.includes("fspid_selftest.c"));
  await page.getByText(/fspid-c.zip is in the downloads: .*fspid.c, /).waitFor();
  const mockup = page.getByRole("button", { name: "save fmu3" });
  await mockup.focus();
  const [unit] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("Enter")]);
  assert.equal(unit.suggestedFilename(), "fspid-fmu3.zip");
  await page.getByText(/sources only: a page has no compiler/).waitFor();
  // Of another text it says nothing.
  await field.fill("2.5");
  await field.press("Enter");
  await page.getByText(/sources only/).waitFor({ state: "detached" });
  await page.locator("[data-test=export-controller]").selectOption("CPID");
  assert.equal(await page.locator("[data-export=table]").count(), 0);
  await page.getByRole("button", { name: "copy the command for fmu3" }).click();
  await page.getByText(/the command for fmu3 is in the clipboard|by hand/).waitFor();
  await close(page);
});

test("a bad text is marked at its lines and does not fly", async () => {
  const page = await opened();
  await page.click("#tab-keep");
  await page.fill("[data-test=text]", STEP.replace("kp = 3.5287", "kpp = 3.5287"));
  const problems = page.getByRole("alert", { name: "problems" });
  await problems.waitFor();
  assert.match(await problems.innerText(), /line 23, column 1.*kpp.*kp/s);
  assert.match(await problems.innerText(), /last text that could fly/);
  // What stands there as settled is of another text, and says so.
  assert.match(await page.locator(".verdicts.old").innerText(), /of the last text that could fly.*settled/s);
  await page.fill("[data-test=text]", STEP);
  await page.locator(".verdicts:not(.old)").waitFor();
  await close(page);
});

test("on a phone nothing is cut off, in any view, light or dark", async () => {
  for (const colorScheme of ["light", "dark"]) {
    const page = await opened({ viewport: { width: 390, height: 800 }, colorScheme });
    for (const view of VIEWS) {
      await page.click(`#tab-${view}`);
      await page.waitForTimeout(400);
      const [wide, room] = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
      assert.ok(wide <= room, `${view}, ${colorScheme}: ${wide} px in ${room} px`);
    }
    await close(page);
  }
});

test("axe finds nothing serious in any view, light or dark", async () => {
  for (const colorScheme of ["light", "dark"]) {
    const page = await opened({ colorScheme });
    await page.evaluate(AXE);
    await page.locator(`[data-path="${KP}"] .ask`).click();
    await page.locator("[data-test=holds] summary").waitFor();
    for (const view of VIEWS) {
      await page.click(`#tab-${view}`);
      await page.waitForTimeout(800);
      // Between light and dark nothing but colours differs.
      const rules = colorScheme === "dark" ? { runOnly: ["color-contrast"] } : {};
      const found = await page.evaluate((rules) => axe.run(document, { resultTypes: ["violations"], ...rules }), rules);
      assert.equal(found.testEngine.name, "axe-core");
      const serious = found.violations.filter((it) => ["serious", "critical"].includes(it.impact));
      const told = serious.map((it) => `${it.id}: ${it.nodes.map((node) => node.target.join(" ")).join(", ")}`);
      assert.deepEqual(told, [], `${view}, ${colorScheme}`);
    }
    await close(page);
  }
});
