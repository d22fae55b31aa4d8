// The worker as the page sees it: questions and promises of answers, of each kind at most one on its way and one waiting.
import type { Answer } from "./wasm";
import type { Letters } from "./worker";

/** A question that was overtaken by a newer one of its kind. */
export const OVERTAKEN = Symbol("overtaken");

export class Engine {
  #worker: Worker;
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
    worker.postMessage({ wasm: mathematics() });
    return worker;
  }

  /** Ends it, with whatever it computes: a proof that nobody wants any more. */
  end(): void {
    this.#worker.terminate();
    for (const answer of this.#waiting.values()) answer({ json: { refused: "stopped" }, columns: [] });
    this.#waiting.clear();
  }

  ask(verb: string, rest: object = {}): Promise<Answer> {
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

/** Where the mathematics is: letters in the page, or a file that a server has. */
function mathematics(): Letters | string {
  const element = document.getElementById("fspid-wasm");
  const letters = element?.textContent;
  return letters ? { letters, bytes: Number(element.dataset["bytes"]) } : new URL("fspid.wasm", location.href).href;
}
