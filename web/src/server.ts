// The server, where there is one: scenarios of a folder, long jobs, telemetry. Without a token in the address there is none.

export interface Listed {
  id: string;
  name: string;
}

export interface Read extends Listed {
  text: string;
  digest: string;
}

/** A scenario that changed on disk since it was read. */
export class Conflict extends Error {}

/** What the server does not do, with its sentence. */
export class Refused extends Error {}

export type JobKind = "tune" | "campaign" | "contest" | "certify" | "check";
export type JobState = "waiting" | "running" | "done" | "failed" | "cancelled";

/** A job as the list of them has it. */
export interface Job {
  job: string;
  kind: JobKind;
  scenario: string;
  options: Record<string, unknown>;
  state: JobState;
}

/** A run of a campaign as a scenario of its own. */
export interface Run {
  run: number;
  changes: string[];
  text: string;
}

export interface Event {
  event: string;
  data: any;
  /** Its number, where it can be asked for again. */
  id: string | null;
}

/** How the stream of a job ends. */
const ENDS = ["done", "failed", "cancelled"];
/** How often a stream that broke off is taken up again. */
const TRIES = 5;

export class Served {
  constructor(private readonly token: string) {}

  async #ask(path: string, options: RequestInit = {}): Promise<Response> {
    const headers: Record<string, string> = { "X-Fspid-Token": this.token, ...(options.headers as Record<string, string>) };
    if (options.body) headers["Content-Type"] = "application/json";
    const found = await fetch(path, { ...options, headers, credentials: "same-origin" });
    if (found.status === 409) throw new Conflict("the file has changed since it was read");
    if (!found.ok) throw new Refused(sentence(await found.text()) || `${found.status} ${found.statusText}`);
    return found;
  }

  async #json(path: string): Promise<any> {
    return (await this.#ask(path)).json();
  }

  async scenarios(): Promise<Listed[]> {
    return this.#json("/api/scenarios");
  }

  async read(id: string): Promise<Read> {
    return this.#json(`/api/scenarios/${encodeURIComponent(id)}`);
  }

  async save(id: string, text: string, digest: string): Promise<string> {
    const body = JSON.stringify({ text, digest });
    return (await (await this.#ask(`/api/scenarios/${encodeURIComponent(id)}`, { method: "PUT", body })).json()).digest;
  }

  async jobs(): Promise<Job[]> {
    return this.#json("/api/jobs");
  }

  async start(kind: JobKind, id: string, options: object): Promise<string> {
    const body = JSON.stringify({ kind, id, options });
    return (await (await this.#ask("/api/jobs", { method: "POST", body })).json()).job;
  }

  async cancel(job: string): Promise<void> {
    await this.#ask(`/api/jobs/${encodeURIComponent(job)}`, { method: "DELETE" });
  }

  async run(job: string, run: number): Promise<Run> {
    return this.#json(`/api/jobs/${encodeURIComponent(job)}/runs/${run}`);
  }

  async report(job: string): Promise<string> {
    return (await this.#json(`/api/jobs/${encodeURIComponent(job)}/report`)).html;
  }

  /** What is heard of telemetry; none where the server hears none. */
  async hears(): Promise<{ port: number } | null> {
    return (await this.#json("/api/health")).telemetry;
  }

  /** Everything that a job tells, until it ends or `stop` is asked for; a stream that breaks off goes on where it was. */
  async *job(job: string, stop: AbortSignal): AsyncGenerator<Event> {
    const path = `/api/jobs/${encodeURIComponent(job)}/events`;
    let last: string | null = null;
    for (let tries = 0; tries < TRIES && !stop.aborted; tries += 1) {
      try {
        for await (const event of this.#events(path, stop, last)) {
          [tries, last] = [0, event.id ?? last];
          yield event;
          if (ENDS.includes(event.event)) return;
        }
      } catch (error) {
        if (error instanceof Refused) throw error;
      }
      await new Promise((resolve) => setTimeout(resolve, 300 * (tries + 1)));
    }
    if (!stop.aborted) throw new Error("the server does not answer any more");
  }

  telemetry(stop: AbortSignal): AsyncGenerator<Event> {
    return this.#events("/api/telemetry/events", stop, null);
  }

  // `EventSource` sends no header, so the stream is read by hand.
  async *#events(path: string, signal: AbortSignal, last: string | null): AsyncGenerator<Event> {
    const headers: Record<string, string> = last === null ? {} : { "Last-Event-ID": last };
    const body = (await this.#ask(path, { signal, headers })).body;
    if (!body) return;
    let rest = "";
    for await (const piece of pieces(body)) {
      rest += piece;
      let end;
      while ((end = /\r?\n\r?\n/.exec(rest))) {
        const block = rest.slice(0, end.index);
        rest = rest.slice(end.index + end[0].length);
        const event = parsed(block);
        if (event) yield event;
      }
    }
  }
}

/** The sentence of a refusal, `{"error": sentence}`. */
function sentence(body: string): string {
  try {
    return JSON.parse(body).error ?? body;
  } catch {
    return body;
  }
}

async function* pieces(body: ReadableStream<Uint8Array>): AsyncGenerator<string> {
  const reader = body.getReader();
  const decoder = new TextDecoder();
  try {
    for (;;) {
      const { done, value } = await reader.read();
      if (done) return;
      yield decoder.decode(value, { stream: true });
    }
  } finally {
    // Whoever leaves the stream closes it: the server has a few of them only.
    void reader.cancel().catch(() => {});
  }
}

function parsed(block: string): Event | null {
  let [event, id]: [string, string | null] = ["message", null];
  const data: string[] = [];
  for (const line of block.split(/\r?\n/)) {
    const [, field, value] = /^(\w+): ?(.*)$/.exec(line) ?? [];
    if (field === "event") event = value ?? "";
    if (field === "id") id = value ?? null;
    if (field === "data") data.push(value ?? "");
  }
  return data.length ? { event, data: JSON.parse(data.join("\n")), id } : null;
}

/** The server that the address names a token of. */
export function served(): Served | null {
  const token = new URLSearchParams(location.hash.slice(1)).get("token");
  return token ? new Served(token) : null;
}
