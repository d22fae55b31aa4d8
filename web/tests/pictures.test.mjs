// The page as it looks, held against small stored pictures that a person has looked at. PICTURES=write stores them anew;
// a picture that differs is left beside them, with the ending .now.png. Run by `web/test.sh`.
import assert from "node:assert/strict";
import { existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const path = (name) => fileURLToPath(new URL(name, import.meta.url));
const PAGE = pathToFileURL(path("../dist/page.html")).href;
const STORED = path("pictures");
const VIEWS = ["fly", "shape", "judge", "explain", "many", "watch", "keep"];
const LOOKS = [
  { name: "wide-light", width: 1400, height: 1000, colorScheme: "light", views: VIEWS },
  { name: "wide-dark", width: 1400, height: 1000, colorScheme: "dark", views: ["fly", "shape", "judge"] },
  { name: "phone-light", width: 390, height: 844, colorScheme: "light", views: ["fly", "shape"] },
  { name: "phone-dark", width: 390, height: 844, colorScheme: "dark", views: VIEWS },
  { name: "print", width: 1000, height: 1400, colorScheme: "light", media: "print", views: ["fly", "judge"] },
];
// Letters are drawn a little differently from browser to browser: what is compared is the mean of squares of 10 px, each channel.
const SQUARE_PX = 10;
const DIFFERENT = 40;
const SHARE_ALLOWED = 0.02;
// A machine that does much else draws late: a picture is taken again until it is the stored one, for so long at most.
const FIRST_MS = 900;
const AGAIN_MS = 1500;
const TIMES = 20;

let browser;
before(async () => (browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] })));
after(() => browser?.close());

async function opened({ width, height, colorScheme, media }) {
  const page = await browser.newPage({ viewport: { width, height }, colorScheme, reducedMotion: "reduce" });
  page.setDefaultTimeout(180_000);
  if (media) await page.emulateMedia({ media });
  await page.goto(PAGE);
  await page.waitForFunction(() => Number(document.querySelector("#panel")?.dataset.flights) >= 1);
  return page;
}

/** The window as a PNG in which each pixel is the mean of a square. */
async function picture(page, bench) {
  const shot = `data:image/png;base64,${(await page.screenshot()).toString("base64")}`;
  const small = await bench.evaluate(
    async ([shot, square]) => {
      const image = await createImageBitmap(await (await fetch(shot)).blob());
      const [width, height] = [Math.floor(image.width / square), Math.floor(image.height / square)];
      const canvas = Object.assign(document.createElement("canvas"), { width, height });
      const context = canvas.getContext("2d");
      context.imageSmoothingQuality = "high";
      context.drawImage(image, 0, 0, width, height);
      return canvas.toDataURL("image/png");
    },
    [shot, SQUARE_PX],
  );
  return Buffer.from(small.split(",")[1], "base64");
}

/** The share of squares that are clearly different; all of them where the sizes are. */
async function difference(bench, one, other) {
  return bench.evaluate(
    async ([one, other, different]) => {
      const pixels = async (base64) => {
        const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${base64}`)).blob());
        const canvas = Object.assign(document.createElement("canvas"), { width: image.width, height: image.height });
        const context = canvas.getContext("2d");
        context.drawImage(image, 0, 0);
        return context.getImageData(0, 0, image.width, image.height);
      };
      const [a, b] = [await pixels(one), await pixels(other)];
      if (a.width !== b.width || a.height !== b.height) return 1;
      let count = 0;
      for (let at = 0; at < a.data.length; at += 4) {
        const apart = [0, 1, 2].map((channel) => Math.abs(a.data[at + channel] - b.data[at + channel]));
        if (Math.max(...apart) > different) count += 1;
      }
      return count / (a.width * a.height);
    },
    [one.toString("base64"), other.toString("base64"), DIFFERENT],
  );
}

for (const look of LOOKS) {
  test(`the page looks as it did: ${look.name}`, async () => {
    const page = await opened(look);
    // Pictures are made small and compared in a page of their own.
    const bench = await browser.newPage();
    const wrong = [];
    mkdirSync(STORED, { recursive: true });
    for (const view of look.views) {
      await page.evaluate((id) => document.getElementById(id).click(), `tab-${view}`);
      await page.waitForTimeout(FIRST_MS);
      let now = await picture(page, bench);
      const file = `${STORED}/${look.name}-${view}.png`;
      const left = file.replace(".png", ".now.png");
      if (process.env.PICTURES === "write") {
        writeFileSync(file, now);
        continue;
      }
      const apart = async () => (existsSync(file) ? difference(bench, readFileSync(file), now) : 1);
      let share = await apart();
      for (let again = 0; share > SHARE_ALLOWED && existsSync(file) && again < TIMES; again += 1) {
        await page.waitForTimeout(AGAIN_MS);
        now = await picture(page, bench);
        share = await apart();
      }
      if (share > SHARE_ALLOWED) writeFileSync(left, now);
      else rmSync(left, { force: true });
      if (share > SHARE_ALLOWED) wrong.push(`${view}: ${(100 * share).toFixed(1)} % of its squares differ`);
    }
    await bench.close();
    await page.close();
    assert.deepEqual(wrong, []);
  });
}
