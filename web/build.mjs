// The page in two forms: as files beside each other for a server, and as one file that works from disk.
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, rmSync, writeFileSync, copyFileSync } from "node:fs";
import { build } from "vite";
import { toLetters } from "./src/letters.mjs";
import { svelte } from "@sveltejs/vite-plugin-svelte";

const out = "dist/site";

// Scenarios of the repository that name no file beside them; others come with the mathematics.
const SCENARIOS = ["747-pitch-step", "limits", "disturbances", "requirements", "plant-change"];
const scenarios = SCENARIOS.map((name) => ({
  name: `scenarios/${name}`,
  about: "",
  text: readFileSync(`../scenarios/${name}.toml`, "utf8"),
}));

rmSync(out, { recursive: true, force: true });
mkdirSync(out, { recursive: true });

/** One script without imports, and its style. */
async function script(entry, name, plugins) {
  await build({
    configFile: false,
    logLevel: "warn",
    plugins,
    define: { __SCENARIOS__: JSON.stringify(scenarios) },
    build: {
      outDir: out,
      emptyOutDir: false,
      target: "es2022",
      cssCodeSplit: false,
      lib: { entry, name: "fspid", formats: ["iife"], fileName: () => `${name}.js`, cssFileName: name },
    },
  });
}

await script("src/worker.ts", "worker", []);
await script("src/first.ts", "first", []);
await script("src/main.ts", "app", [svelte()]);
copyFileSync("dist/fspid.wasm", `${out}/fspid.wasm`);

const text = (name) => readFileSync(`${out}/${name}`, "utf8");
const template = readFileSync("src/index.html", "utf8");
const fill = (parts) => template.replace(/<!-- (\w+) -->/g, (_, name) => parts[name] ?? "");

writeFileSync(
  `${out}/index.html`,
  fill({
    style: '<link rel="stylesheet" href="app.css">',
    script: '<script src="app.js" defer></script>',
  }),
);

// Nothing in a script may end the element that it stands in.
const quiet = (source) => source.replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
// Zopfli looks longer for what gzip would find: one part in 25 less. Who is in a hurry asks gzip.
const packers = { gzip: ["gzip", "--stdout", "--fast"], zopfli: ["zopfli", "-c", "--i5"] };
const packed = (id, file) => {
  const [packer, ...options] = packers[process.env.FSPID_PACKS_WITH ?? "zopfli"];
  const zipped = execFileSync(packer, [...options, file], { maxBuffer: 2 ** 26 });
  return `<script type="text/plain" id="${id}" data-bytes="${zipped.length}">${toLetters(zipped)}</script>`;
};
writeFileSync(
  "dist/page.html",
  fill({
    style: `<style>${text("app.css")}</style>`,
    data: [
      `<script type="text/plain" id="fspid-worker">${quiet(text("worker.js"))}</script>`,
      packed("fspid-app", `${out}/app.js`),
      packed("fspid-wasm", "dist/fspid.wasm"),
      "<!-- scenario -->",
    ].join("\n"),
    script: `<script>${quiet(text("first.js"))}</script>`,
  }),
);
// A server has no use for it.
rmSync(`${out}/first.js`);
