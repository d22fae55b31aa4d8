// All mathematics happens here, so that the page never waits.
import { Mathematics, type Answer } from "./wasm";

interface Asked {
  id: number;
  question: object;
}

let module: Promise<WebAssembly.Module> | undefined;
let mathematics: Mathematics | undefined;

async function ready(): Promise<Mathematics> {
  if (!module) throw new Error("the mathematics was not loaded");
  mathematics ??= new Mathematics(await WebAssembly.instantiate(await module, {}));
  return mathematics;
}

function answer(id: number, found: Answer): void {
  const buffers = found.columns.map((column) => column.buffer as ArrayBuffer);
  postMessage({ id, ...found }, { transfer: buffers });
}

/** What a fault in the mathematics leaves behind is thrown away; the next question finds it anew. */
function fault(id: number, error: unknown): void {
  mathematics = undefined;
  answer(id, { json: { refused: `a fault in the mathematics: ${String(error)}` }, columns: [] });
}

onmessage = async ({ data }: MessageEvent<Asked & { wasm?: ArrayBuffer | string }>) => {
  try {
    if (data.wasm !== undefined) {
      const { wasm } = data;
      module = (typeof wasm === "string"
        ? WebAssembly.compileStreaming(fetch(wasm))
        : WebAssembly.compile(wasm));
      return;
    }
    answer(data.id, (await ready()).ask(data.question));
  } catch (error) {
    fault(data.id, error);
  }
};
