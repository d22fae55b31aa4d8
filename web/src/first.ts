// The page as one file: its script is packed as its mathematics is, and begins here.
import { fromLetters } from "./letters.mjs";

async function begin(packed: HTMLElement): Promise<void> {
  const bytes = fromLetters(packed.textContent ?? "", Number(packed.dataset["bytes"]));
  const whole = new Response(bytes as Uint8Array<ArrayBuffer>).body!.pipeThrough(new DecompressionStream("gzip"));
  const script = document.createElement("script");
  script.text = await new Response(whole).text();
  document.body.append(script);
}

const packed = document.getElementById("fspid-app");
if (packed) void begin(packed);
