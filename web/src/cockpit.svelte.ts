// What the page knows: the scenario's text, what was answered of it, and what can be undone.
import { Engine, OVERTAKEN } from "./engine";
import { served, type Listed, type Served } from "./server";
import type { Flight, Judged, Judgement, Moment, Problem, Shape, Summary, Trace } from "./types";
import type { Answer } from "./wasm";

export interface Shipped {
  name: string;
  about: string;
  text: string;
}

/** Those of the repository, put in by the build. */
declare const __SCENARIOS__: Shipped[];

export type View = "fly" | "shape" | "judge" | "explain" | "many" | "watch" | "keep";

/** A scenario that is flown in the place of the person's own, which stays as it is: the best candidate so far, a bad run. */
export interface Guest {
  title: string;
  text: string;
  flight: Flight;
}

/** Views in which a guest is shown; the others are about the person's own scenario. */
const WITH_GUESTS: View[] = ["fly", "many"];

/** How long nothing moves before the whole scenario is read again, in ms. */
const REST_MS = 60;

class Cockpit {
  readonly engine = new Engine();
  readonly server: Served | null = served();

  shipped = $state.raw<Shipped[]>([]);
  listed = $state.raw<Listed[]>([]);
  view = $state<View>("fly");
  /** What it is called, and where the server has it. */
  name = $state("");
  id = $state<string | null>(null);
  /** The digest that the server gave of the text that was read. */
  readDigest = $state("");
  /** The text as it was opened or saved last. */
  original = $state("");
  text = $state("");
  past = $state.raw<string[]>([]);
  future = $state.raw<string[]>([]);

  summary = $state.raw<Summary | null>(null);
  problems = $state.raw<Problem[]>([]);
  refused = $state("");
  /** The flight of the scenario itself. */
  own = $state.raw<Flight | null>(null);
  guest = $state.raw<Guest | null>(null);
  /** Whether candidates of a search may come as guests while they get better. */
  live = $state(true);
  pinned = $state.raw<{ text: string; traces: Trace[] } | null>(null);
  judged = $state.raw<Judged | null>(null);
  judgeRefused = $state("");
  verified = $state.raw<any>(null);
  sets = $state<string[]>([]);
  shape = $state.raw<Shape | null>(null);
  moment = $state.raw<Moment | null>(null);
  momentRefused = $state("");
  controller = $state("");
  at_s = $state(0);
  certified = $state.raw<any>(null);
  certifying = $state("");
  /** How many flights were drawn: for tests that wait. */
  flights = $state(0);
  /** How many moves of a value are on their way, until the scenario is read as a whole: for tests that wait. */
  moving = $state(0);

  get tuned(): string[] {
    return this.summary?.controllers.filter((it) => it.kind === "self-tuning").map((it) => it.name) ?? [];
  }

  /** What the flight view shows. */
  get flight(): Flight | null {
    return this.guest?.flight ?? this.own;
  }

  /** Whether what is shown is of an earlier text, because something is wrong with this one. */
  get isBehind(): boolean {
    return this.guest === null && this.own !== null && this.own.of !== this.text && (this.problems.length > 0 || this.refused !== "");
  }

  get isChanged(): boolean {
    return this.text !== this.original;
  }

  /** The first scenario: the server's, the page's own, or one that comes with fspid. */
  async begin(): Promise<void> {
    this.shipped = __SCENARIOS__;
    const own = document.getElementById("fspid-scenario")?.textContent;
    try {
      this.listed = (await this.server?.scenarios()) ?? [];
    } catch (error) {
      this.refused = String(error);
    }
    const [first] = this.listed;
    if (first) await this.read(first.id);
    else if (own) await this.open(JSON.parse(own).name, JSON.parse(own).text);
    else if (this.shipped[0]) await this.open(this.shipped[0].name, this.shipped[0].text);
    const { json } = await this.engine.ask("shipped");
    this.shipped = [...__SCENARIOS__, ...(json.scenarios ?? [])];
  }

  /** A scenario of the server's folder. */
  async read(id: string): Promise<void> {
    try {
      const found = await this.server!.read(id);
      await this.open(found.name, found.text, found.id, found.digest);
    } catch (error) {
      this.refused = String(error);
    }
  }

  async open(name: string, text: string, id: string | null = null, digest = ""): Promise<void> {
    Object.assign(this, { name, id, readDigest: digest, original: text, past: [], future: [] });
    Object.assign(this, { pinned: null, certified: null, moment: null, own: null, guest: null, judged: null, at_s: 0 });
    this.text = text;
    this.controller = "";
    await this.refresh();
  }

  /** Another text; one step that can be undone, unless it only moves on from `before`. */
  async change(text: string, before = this.text): Promise<void> {
    this.#keep(text, before);
    await this.refresh();
  }

  #keep(text: string, before: string): void {
    this.live = false;
    if (before !== text && this.past.at(-1) !== before) this.past = [...this.past, before];
    this.future = [];
    this.text = text;
  }

  async undo(): Promise<void> {
    const before = this.past.at(-1);
    if (before === undefined) return;
    this.future = [...this.future, this.text];
    this.past = this.past.slice(0, -1);
    this.text = before;
    await this.refresh();
  }

  async redo(): Promise<void> {
    const after = this.future.at(-1);
    if (after === undefined) return;
    this.past = [...this.past, this.text];
    this.future = this.future.slice(0, -1);
    this.text = after;
    await this.refresh();
  }

  /** A value in the place of another, from the text before a slider began to move; false where it was not taken. */
  async set(path: string, value: string, before = this.text): Promise<boolean> {
    this.moving += 1;
    try {
      return await this.#set(path, value, before);
    } finally {
      this.moving -= 1;
    }
  }

  async #set(path: string, value: string, before: string): Promise<boolean> {
    const found = await this.engine.latest("set", "set", { text: before, path, value });
    if (found === OVERTAKEN) return false;
    if (found.json.text === undefined) {
      this.tell(found);
      return false;
    }
    this.#keep(found.json.text, before);
    this.#place(path, value);
    await this.#move();
    return true;
  }

  /** A number that was set stands in its field at once; the whole scenario is read where the hand rests. */
  #place(path: string, value: string): void {
    const number = Number(value);
    if (!this.summary || !Number.isFinite(number)) return;
    const paths = this.summary.paths.map((it) => (it.path === path && typeof it.value === "number" ? { ...it, value: number } : it));
    this.summary = { ...this.summary, paths };
  }

  /** As `refresh` for a text in which one value was moved: the flight first, all else where no other value follows. */
  async #move(): Promise<void> {
    const { text } = this;
    this.guest = null;
    const found = await this.engine.latest("fly", "fly", { text });
    if (found === OVERTAKEN) return;
    this.#draw(found, text);
    if (this.text === text) await this.look();
    await new Promise((go) => setTimeout(go, REST_MS));
    if (this.text !== text) return;
    const opened = await this.engine.latest("open", "open", { text });
    if (opened !== OVERTAKEN) this.#take(opened);
  }

  tell({ json }: Answer): void {
    this.problems = json.problems ?? [];
    this.refused = json.refused ?? "";
  }

  /** Everything that is shown of the text, anew. */
  async refresh(): Promise<void> {
    const { text } = this;
    this.guest = null;
    // Both are asked for at once, so that the worker does not wait for the page in between, which draws the flight while the
    // worker reads what the scenario holds.
    const flown = this.engine.latest("fly", "fly", { text });
    const opened = this.engine.latest("open", "open", { text });
    const flight = await flown;
    if (flight !== OVERTAKEN) this.#draw(flight, text);
    const summary = await opened;
    if (summary === OVERTAKEN || !this.#take(summary) || flight === OVERTAKEN) return;
    await this.look();
  }

  /** What a scenario holds; false for a text that is none. */
  #take(found: Answer): boolean {
    this.tell(found);
    if (!found.json.paths) return false;
    this.summary = found.json as Summary;
    const names = this.summary.controllers.map((it) => it.name);
    if (!names.includes(this.controller)) this.controller = this.tuned[0] ?? names[0] ?? "";
    return true;
  }

  #draw(found: Answer, of: string): void {
    this.tell(found);
    if (!found.json.simulation) return;
    this.own = flightOf(found, of);
    this.flights += 1;
  }

  /** Flies another scenario in the place of the person's own; why it could not, in a sentence. */
  async visit(title: string, text: string): Promise<string> {
    const own = this.text;
    const found = await this.engine.latest("visit", "fly", { text });
    // Whoever has gone on with the own scenario meanwhile is not disturbed.
    if (found === OVERTAKEN || this.text !== own || !WITH_GUESTS.includes(this.view)) return "";
    const { json } = found;
    if (!json.simulation) return json.refused ?? json.problems?.[0]?.message ?? "it does not fly";
    this.guest = { title, text, flight: flightOf(found, text) };
    this.flights += 1;
    return "";
  }

  /** The person's own scenario again. */
  leave(): void {
    this.guest = null;
    this.live = false;
  }

  /** What the open view shows beside the flight. */
  async look(): Promise<void> {
    if (this.view === "judge") await Promise.all([this.judge(), this.verify()]);
    if (this.view === "shape" || this.view === "explain") await Promise.all([this.shapeOf(), this.explain()]);
  }

  async judge(): Promise<void> {
    const found = await this.engine.latest("judge", "judge", { text: this.text });
    if (found === OVERTAKEN) return;
    const { json } = found;
    this.judgeRefused = json.refused ?? json.problems?.[0]?.message ?? "";
    if (!json.analysis) {
      this.judged = null;
      return;
    }
    const curve = (it: any) => ({ name: it.name, columns: named(it.columns, found) });
    this.judged = { analysis: json.analysis, held: json.held, loops: json.loops.map(curve), poles: json.poles.map(curve) };
  }

  async verify(): Promise<void> {
    const { text } = this;
    const found = await this.engine.latest("verify", "verify", { text, sets: [...this.sets] });
    if (found !== OVERTAKEN) this.verified = found.json;
  }

  async shapeOf(): Promise<void> {
    if (!this.tuned.includes(this.controller)) {
      this.shape = null;
      return;
    }
    const found = await this.engine.latest("shape", "shape", { text: this.text, controller: this.controller });
    if (found === OVERTAKEN || !found.json.curves) return;
    const { json, columns } = found;
    const curves = (numbers: number[]) => numbers.map((at) => columns[at] ?? new Float64Array());
    this.shape = {
      ...json,
      inputs: columns[json.curves.inputs],
      grades: { error: curves(json.curves.error), change: curves(json.curves.change) },
    };
  }

  async explain(): Promise<void> {
    const { text, controller, at_s } = this;
    const found = await this.engine.latest("explain", "explain", { text, controller, at_s });
    if (found === OVERTAKEN) return;
    this.momentRefused = found.json.refused ?? "";
    this.moment = found.json.parts ? found.json : null;
  }

  async certify(controller: string): Promise<void> {
    this.certifying = controller || "all";
    this.certified = null;
    const prover = new Engine();
    this.#prover = prover;
    const { json } = await prover.ask("certify", { text: this.text, controller });
    prover.end();
    if (this.#prover !== prover) return;
    this.certified = { ...json, of: this.text };
    this.certifying = "";
  }

  stopCertifying(): void {
    this.#prover?.end();
    this.#prover = null;
    this.certifying = "";
  }

  #prover: Engine | null = null;

  async figure(kind: string): Promise<string> {
    const { json } = await this.engine.ask("figure", { text: this.text, kind, controller: this.controller });
    return json.svg ?? "";
  }

  requirement(name: string): Judgement[] {
    return this.flight?.requirements.filter((it) => it.controller === name) ?? [];
  }

  show(view: View): void {
    this.view = view;
    if (!WITH_GUESTS.includes(view)) this.guest = null;
    void this.look();
  }
}

/** The flight of a text, with its columns by their names. */
function flightOf(found: Answer, of: string): Flight {
  const { simulation, met, failed, traces } = found.json;
  return {
    of,
    controllers: simulation.controllers,
    requirements: simulation.requirements ?? [],
    notes: simulation.notes ?? [],
    met,
    failed,
    traces: traces.map((trace: any) => ({ ...trace, columns: named(trace.columns, found) })),
  };
}

/** Columns by their names. */
function named(columns: { name: string; at: number }[], answer: Answer): Record<string, Float64Array> {
  return Object.fromEntries(columns.map(({ name, at }) => [name, answer.columns[at] ?? new Float64Array()]));
}

export const cockpit = new Cockpit();
