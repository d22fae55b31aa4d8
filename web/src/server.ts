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

export type JobKind = "tune" | "campaign" | "contest" | "certify";

export interface Event {
  event: string;
  data: any;
}

export class Served {
  constructor(private readonly token: string) {}

  async #ask(path: string, options: RequestInit = {}): Promise<Response> {
    const headers: Record<string, string> = { "X-Fspid-Token": this.token };
    if (options.body) headers["Content-Type"] = "application/json";
    const found = await fetch(path, { ...options, headers, credentials: "same-origin" });
    if (found.status === 409) throw new Conflict("the file has changed since it was read");
    if (!found.ok) throw new Error((await found.text()) || `${found.status} ${found.statusText}`);
    return found;
  }

  async scenarios(): Promise<Listed[]> {
    return (await this.#ask("/api/scenarios")).json();
  }

  async read(id: string): Promise<Read> {
    return (await this.#ask(`/api/scenarios/${encodeURIComponent(id)}`)).json();
  }

  async save(id: string, text: string, digest: string): Promise<string> {
    const body = JSON.stringify({ text, digest });
    return (await (await this.#ask(`/api/scenarios/${encodeURIComponent(id)}`, { method: "PUT", body })).json()).digest;
  }

  async start(kind: JobKind, id: string, options: object): Promise<string> {
    const body = JSON.stringify({ kind, id, options });
    return (await (await this.#ask("/api/jobs", { method: "POST", body })).json()).job;
  }

  async cancel(job: string): Promise<void> {
    await this.#ask(`/api/jobs/${encodeURIComponent(job)}`, { method: "DELETE" });
  }

  /** Everything that a job tells, until it is done or `stop` is asked for. */
  job(job: string, stop: AbortSignal): AsyncGenerator<Event> {
    return this.#events(`/api/jobs/${encodeURIComponent(job)}/events`, stop);
  }

  telemetry(stop: AbortSignal): AsyncGenerator<Event> {
    return this.#events("/api/telemetry/events", stop);
  }

  // `EventSource` sends no header, so the stream is read by hand.
  async *#events(path: string, signal: AbortSignal): AsyncGenerator<Event> {
    const body = (await this.#ask(path, { signal })).body;
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

async function* pieces(body: ReadableStream<Uint8Array>): AsyncGenerator<string> {
  const reader = body.getReader();
  const decoder = new TextDecoder();
  for (;;) {
    const { done, value } = await reader.read();
    if (done) return;
    yield decoder.decode(value, { stream: true });
  }
}

function parsed(block: string): Event | null {
  let event = "message";
  const data: string[] = [];
  for (const line of block.split(/\r?\n/)) {
    const [, field, value] = /^(\w+): ?(.*)$/.exec(line) ?? [];
    if (field === "event") event = value ?? "";
    if (field === "data") data.push(value ?? "");
  }
  return data.length ? { event, data: JSON.parse(data.join("\n")) } : null;
}

/** The server that the address names a token of. */
export function served(): Served | null {
  const token = new URLSearchParams(location.hash.slice(1)).get("token");
  return token ? new Served(token) : null;
}
