// The worker as the page sees it: questions and promises of answers, of each kind at most one on its way and one waiting.
import { fromLetters } from "./letters.mjs";
import type { Answer } from "./wasm";

/** A question that was overtaken by a newer one of its kind. */
export const OVERTAKEN = Symbol("overtaken");

export class Engine {
  #worker: Worker;
  #ready: Promise<void> = Promise.resolve();
  #next = 1;
  #waiting = new Map<number, (answer: Answer) => void>();
  #lanes = new Map<string, Lane>();

  constructor() {
    this.#worker = this.#start();
  }

  #start(): Worker {
    const inline = document.getElementById("fspid-worker")?.textContent;
    const source = inline ? URL.createObjectURL(new Blob([inline], { type: "text/javascript" })) : "worker.js";
    const worker = new Worker(source);
    worker.onmessage = ({ data }) => {
      this.#waiting.get(data.id)?.(data);
      this.#waiting.delete(data.id);
    };
    this.#ready = wasm().then((found) => worker.postMessage({ wasm: found }));
    return worker;
  }

  /** Ends it, with whatever it computes: a proof that nobody wants any more. */
  end(): void {
    this.#worker.terminate();
    for (const answer of this.#waiting.values()) answer({ json: { refused: "stopped" }, columns: [] });
    this.#waiting.clear();
  }

  async ask(verb: string, rest: object = {}): Promise<Answer> {
    await this.#ready;
    const id = this.#next++;
    return new Promise((resolve) => {
      this.#waiting.set(id, resolve);
      this.#worker.postMessage({ id, question: { verb, ...rest } });
    });
  }

  /** As `ask`; of questions of the same kind only the newest is answered, the others are overtaken. */
  async latest(kind: string, verb: string, rest: object = {}): Promise<Answer | typeof OVERTAKEN> {
    const lane = this.#lanes.get(kind) ?? { running: false };
    this.#lanes.set(kind, lane);
    if (lane.running) {
      lane.next?.(false);
      const isMine = await new Promise<boolean>((resolve) => (lane.next = resolve));
      if (!isMine) return OVERTAKEN;
    }
    lane.running = true;
    try {
      return await this.ask(verb, rest);
    } finally {
      const { next } = lane;
      lane.next = undefined;
      lane.running = next !== undefined;
      next?.(true);
    }
  }
}

/** Questions of one kind. */
interface Lane {
  running: boolean;
  /** Whether the one that waits may go. */
  next?: ((go: boolean) => void) | undefined;
}

let found: Promise<ArrayBuffer | string> | undefined;

/** The mathematics as bytes out of the page, or where a server has it. */
function wasm(): Promise<ArrayBuffer | string> {
  found ??= unpacked();
  return found;
}

async function unpacked(): Promise<ArrayBuffer | string> {
  const element = document.getElementById("fspid-wasm");
  const text = element?.textContent;
  if (!text) return new URL("fspid.wasm", location.href).href;
  const packed = fromLetters(text, Number(element.dataset["bytes"]));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}
