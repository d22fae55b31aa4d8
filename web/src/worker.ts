// All mathematics happens here, so that the page never waits.
import { fromLetters } from "./letters.mjs";
import { Mathematics, type Answer } from "./wasm";

/** The mathematics as letters, zipped, and how many bytes that is. */
export interface Letters {
  letters: string;
  bytes: number;
}

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

function compiled(wasm: Letters | string): Promise<WebAssembly.Module> {
  if (typeof wasm === "string") return WebAssembly.compileStreaming(fetch(wasm));
  const packed = new Response(fromLetters(wasm.letters, wasm.bytes) as Uint8Array<ArrayBuffer>).body!;
  const whole = packed.pipeThrough(new DecompressionStream("gzip"));
  return WebAssembly.compileStreaming(new Response(whole, { headers: { "Content-Type": "application/wasm" } }));
}

onmessage = async ({ data }: MessageEvent<Asked & { wasm?: Letters | string }>) => {
  try {
    if (data.wasm !== undefined) {
      module = compiled(data.wasm);
      return;
    }
    answer(data.id, (await ready()).ask(data.question));
  } catch (error) {
    fault(data.id, error);
  }
};
