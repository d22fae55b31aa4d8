// In which interval each number holds: asked in a worker of its own, which "stop" and every newer question end.
import { cockpit } from "./cockpit.svelte";
import { Engine } from "./engine";

/** What lies beyond an end; nothing where the search ended. */
export interface Beyond {
  value: number;
  kind: string;
  why: string;
}

/** The answer of the verb `interval`. */
export interface Interval {
  path: string;
  present: number;
  asked: string;
  looked_at: number;
  holds: boolean;
  least: number | null;
  most: number | null;
  inside: number;
  below: Beyond | null;
  above: Beyond | null;
  nearest: number | null;
  text: string;
}

/** What an answer is about: the text, and the ready sets that are required too. */
interface Asked {
  text: string;
  sets: string;
}

/** What would be asked now. */
function asked(): Asked {
  return { text: cockpit.text, sets: cockpit.sets.join(" ") };
}

/** True if it is about something else than what is shown. */
export function isOld({ text, sets }: Asked): boolean {
  const now = asked();
  return text !== now.text || sets !== now.sets;
}

/** An answer, and what it is about; a refusal has its reason. */
export interface Told {
  of: Asked;
  interval: Interval | null;
  refused: string;
}

class Intervals {
  told = $state.raw<Record<string, Told>>({});
  /** The number that is looked at, how many were, and how many shall be. */
  asking = $state("");
  done = $state(0);
  total = $state(0);
  /** What is looked at now is about this: state, so that who follows is told of the first question too. */
  #of = $state.raw<Asked | null>(null);
  #engine: Engine | null = null;
  #turn = 0;

  /** Of these numbers, one after the other; whatever was looked at before is left. */
  async ask(paths: string[]): Promise<void> {
    this.stop();
    const turn = ++this.#turn;
    const [of, sets] = [asked(), [...cockpit.sets]];
    Object.assign(this, { done: 0, total: paths.length });
    this.#of = of;
    for (const path of paths) {
      this.asking = path;
      const engine = (this.#engine ??= new Engine());
      const { json } = await engine.ask("interval", { text: of.text, path, sets });
      if (turn !== this.#turn) return;
      const refused = json.refused ?? json.problems?.[0]?.message ?? "";
      this.told = { ...this.told, [path]: { of, interval: json.interval ?? null, refused } };
      this.done += 1;
    }
    this.asking = "";
  }

  stop(): void {
    if (!this.asking) return;
    this.#turn += 1;
    this.asking = "";
    this.#engine?.end();
    this.#engine = null;
  }

  /** What is looked at is of no use for another text and other sets. */
  follow(): void {
    if (this.#of && isOld(this.#of)) this.stop();
  }
}

export const intervals = new Intervals();
