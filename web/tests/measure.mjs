// What the page costs, in a real browser: a long check, run by `web/measure.sh` on a quiet machine. Prints a table.
import { readFileSync } from "node:fs";
import { fileURLToPath, pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const PAGE = pathToFileURL(fileURLToPath(new URL("../dist/page.html", import.meta.url))).href;
const SLIDER = '[data-path="controller.FSPID.nominal.kp"] input[type=range]';
const REDRAWS = Number(process.env.REDRAWS ?? 10_000);
const ROUNDS = 5;

const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] });
const tell = (what, found, asked) => console.log(`${what}: ${found} (asked: ${asked})`);
const median = (values) => values.toSorted((a, b) => a - b)[Math.floor(values.length / 2)];

async function opened() {
  const page = await browser.newPage({ viewport: { width: 1400, height: 900 } });
  page.setDefaultTimeout(180_000);
  await page.goto(PAGE);
  await page.waitForFunction(() => Number(document.querySelector("#panel")?.dataset.flights) >= 1);
  return page;
}

/** First paint, and when the first flight is drawn and sliders answer, in ms since the address was asked for. */
async function opening() {
  const found = [];
  for (let round = 0; round < ROUNDS; round += 1) {
    const page = await browser.newPage({ viewport: { width: 1400, height: 900 } });
    // `page` of Playwright is told late; the page itself looks at every frame.
    await page.addInitScript(() => {
      const look = () => {
        const drawn = Number(document.querySelector("#panel")?.dataset.flights) >= 1;
        if (drawn) window.firstFlight = performance.now();
        else requestAnimationFrame(look);
      };
      requestAnimationFrame(look);
    });
    await page.goto(PAGE);
    await page.waitForFunction(() => window.firstFlight !== undefined);
    found.push(await page.evaluate(() => [performance.getEntriesByName("first-contentful-paint")[0]?.startTime ?? NaN, window.firstFlight]));
    await page.close();
  }
  return [0, 1].map((at) => median(found.map((it) => it[at])));
}

/** Frames a second, and flights drawn a second, while a slider moves with every frame. */
async function dragging(page, seconds) {
  return page.evaluate(
    ([selector, seconds]) =>
      new Promise((resolve) => {
        const slider = document.querySelector(selector);
        const panel = document.querySelector("#panel");
        const [low, high] = slider ? [Number(slider.min), Number(slider.max)] : [0, 1];
        const flights = () => Number(panel?.dataset.flights ?? 0);
        const [begun, before] = [performance.now(), flights()];
        let frames = 0;
        const frame = () => {
          frames += 1;
          const passed = (performance.now() - begun) / 1000;
          if (slider) {
            slider.value = String(low + (high - low) * (0.5 + 0.3 * Math.sin(3 * passed)));
            slider.dispatchEvent(new Event("input", { bubbles: true }));
          }
          if (passed < seconds) requestAnimationFrame(frame);
          else resolve({ frames: frames / passed, flights: (flights() - before) / passed });
        };
        requestAnimationFrame(frame);
      }),
    [SLIDER, seconds],
  );
}

/** Memory of the page's process in MB, worker and mathematics included, after its garbage is gone. */
async function memory(page) {
  const client = await page.context().newCDPSession(page);
  await client.send("HeapProfiler.collectGarbage");
  await client.detach();
  const system = await browser.newBrowserCDPSession();
  const { processInfo } = await system.send("SystemInfo.getProcessInfo");
  await system.detach();
  const sizes = processInfo.filter((it) => it.type === "renderer").map((it) => Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${it.id}/status`, "utf8"))?.[1] ?? 0));
  return Math.round(Math.max(...sizes) / 1024);
}

const [paint, interactive] = await opening();
tell("first paint", `${Math.round(paint)} ms`, "300 ms");
tell("first flight drawn, all answers", `${Math.round(interactive)} ms`, "500 ms");

const empty = await browser.newPage();
await empty.setContent("<p>empty</p>");
const still = await dragging(empty, 4);
await empty.close();
const page = await opened();
const drag = await dragging(page, 6);
tell("frames while a gain is dragged", `${drag.frames.toFixed(1)} a second, ${(drag.frames / still.frames).toFixed(2)} of an empty page (${still.frames.toFixed(1)})`, "60");
tell("flights drawn while it is dragged", `${drag.flights.toFixed(1)} a second`, "60");

const redraws = () => page.locator("#panel").getAttribute("data-flights").then(Number);
const sizes = [];
for (const part of [0.1, 0.25, 0.5, 0.75, 1]) {
  while ((await redraws()) < part * REDRAWS) await dragging(page, 5);
  sizes.push(`${await redraws()}: ${await memory(page)} MB`);
}
tell("memory of the page's process after so many redraws", sizes.join(", "), "flat");
await browser.close();
