// A real loop as telemetry tells it, and the open scenario flown with the same set-point. It is heard whatever view is open.
import { cockpit } from "./cockpit.svelte";
import { OVERTAKEN } from "./engine";
import { saved } from "./save";
import { Refused } from "./server";

/** Lines that are kept for the picture, and lines of a record. */
const MOST_LINES = 20_000;
const MOST_RECORDED = 200_000;
/** Names that are kept; a line has 32 at most, but each could have others. */
const MOST_NAMES = 32;
/** How often the picture is drawn anew, and how often the model flies at most. */
const PICTURE_MS = 100;
const MODEL_MS = 400;
/** The longest flight of the model, and the most changes of the set-point that it is given. */
const LONGEST_S = 600;
const MOST_CHANGES = 2000;
/** Times that go back by more than this begin a new flight; less is a line out of its order. */
const BACK_S = 0.5;

const TIME = "time_s";
const SETPOINT = "setpoint_deg";

type Line = Record<string, number>;

/** The open scenario, flown with the set-point that was told. */
interface Model {
  controllers: string[];
  time_s: Float64Array;
  columns: Record<string, Record<string, Float64Array>>;
}

export interface Difference {
  largest_deg: number;
  at_s: number;
  rms_deg: number;
  lines: number;
}

/** What the view draws. */
export interface Picture {
  time_s: Float64Array;
  values: Record<string, Float64Array>;
  model_deg: Float64Array;
  command_deg: Float64Array;
  difference_deg: Float64Array;
  difference: Difference | null;
}

class Watching {
  state = $state<"off" | "none" | "listening" | "broken">("off");
  told = $state("");
  port = $state(0);
  heard = $state(0);
  bad = $state(0);
  lastBad = $state("");
  lost = $state(0);
  late = $state(0);
  flights = $state(1);
  paused = $state(false);
  recording = $state(false);
  recorded = $state(0);
  /** Seconds that are drawn; 0 for all that are kept. */
  window_s = $state(60);
  controller = $state("");
  picture = $state.raw<Picture | null>(null);
  modelSays = $state("");
  /** Pitch at the first line of this flight: a model that begins at rest begins there with a difference. */
  first_deg = $state<number | null>(null);

  #time: number[] = [];
  #values = new Map<string, number[]>();
  #begin_s = 0;
  #changes: [time_s: number, value_deg: number][] = [];
  #record: Line[] = [];
  #model: Model | null = null;
  #modelOf = "";
  #flown = 0;
  #drawing: ReturnType<typeof setInterval> | undefined;
  #isDirty = false;
  #isDrawing = false;
  /** How often everything was forgotten: what was asked before is of no use then. */
  #forgotten = 0;
  #isFlying = false;

  get names(): string[] {
    return [...this.#values.keys()];
  }

  /** Listens until the page is left. */
  async listen(): Promise<void> {
    if (this.state === "listening" || !cockpit.server) return;
    this.state = "listening";
    try {
      if (!(await cockpit.server.hears())) {
        this.state = "none";
        return;
      }
      this.#drawing ??= setInterval(() => void this.#draw(), PICTURE_MS);
      await this.#hear();
    } catch (error) {
      this.told = error instanceof Refused ? error.message : "the server does not answer";
      this.state = "broken";
    }
  }

  async #hear(): Promise<void> {
    for (let tries = 0; ; tries += 1) {
      try {
        for await (const { data } of cockpit.server!.telemetry(new AbortController().signal)) {
          [tries, this.told] = [0, ""];
          [this.port, this.bad, this.lastBad] = [data.port, data.bad, data.last_bad ?? ""];
          this.lost += data.lost ?? 0;
          if (Array.isArray(data.lines)) data.lines.forEach((line: Line) => this.#take(line));
        }
      } catch (error) {
        if (error instanceof Refused || tries > 20) throw error;
      }
      this.told = "the server does not answer; it is asked again";
      await new Promise((resolve) => setTimeout(resolve, 1000));
    }
  }

  #take(line: Line): void {
    this.heard += 1;
    this.#isDirty = true;
    if (this.recording) this.#note(line);
    const time_s = line[TIME]!;
    const last = this.#time.at(-1);
    if (last !== undefined && time_s < last - BACK_S) {
      this.#forget();
      this.flights += 1;
    } else if (last !== undefined && time_s <= last) {
      this.late += 1;
      return;
    }
    if (!this.#time.length) [this.#begin_s, this.first_deg] = [time_s, line["measurement_deg"] ?? null];
    this.#keep(time_s, line);
    this.#follow(time_s - this.#begin_s, line[SETPOINT]);
  }

  #keep(time_s: number, line: Line): void {
    for (const name of Object.keys(line)) {
      if (name !== TIME && !this.#values.has(name) && this.#values.size < MOST_NAMES) this.#values.set(name, this.#time.map(() => NaN));
    }
    this.#time.push(time_s);
    for (const [name, values] of this.#values) values.push(line[name] ?? NaN);
    // In parts, for one by one would move all of them each time.
    if (this.#time.length > MOST_LINES * 1.1) {
      const more = this.#time.length - MOST_LINES;
      this.#time.splice(0, more);
      for (const values of this.#values.values()) values.splice(0, more);
    }
  }

  /** Remembers where the set-point changes: that is all that the model needs of it. */
  #follow(at_s: number, value_deg: number | undefined): void {
    if (value_deg === undefined || this.#changes.at(-1)?.[1] === value_deg) return;
    if (this.#changes.length < MOST_CHANGES) this.#changes.push([at_s, value_deg]);
    if (this.#changes.length === MOST_CHANGES) this.modelSays = `The set-point has changed ${MOST_CHANGES} times; the model does not follow it any further. "Clear" begins anew.`;
  }

  #note(line: Line): void {
    this.#record.push(line);
    this.recorded = this.#record.length;
    if (this.#record.length >= MOST_RECORDED) this.stopRecording();
  }

  #forget(): void {
    this.#forgotten += 1;
    this.#time = [];
    this.#values.clear();
    this.#changes = [];
    [this.#model, this.#modelOf, this.modelSays, this.first_deg] = [null, "", "", null];
    this.#isDirty = true;
  }

  /** Begins anew with the next line. */
  clear(): void {
    this.#forget();
    [this.heard, this.lost, this.late, this.flights, this.picture] = [0, 0, 0, 1, null];
  }

  record(): void {
    [this.#record, this.recorded, this.recording] = [[], 0, true];
  }

  /** Ends the record and hands it over as a file. */
  stopRecording(): void {
    this.recording = false;
    const names = [TIME, ...new Set(this.#record.flatMap((line) => Object.keys(line).filter((name) => name !== TIME)))];
    const cell = (name: string) => (/[",\n\r]/.test(name) ? `"${name.replaceAll('"', '""')}"` : name);
    const rows = this.#record.map((line) => names.map((name) => line[name] ?? "").join(","));
    saved("telemetry.csv", `${[names.map(cell).join(","), ...rows].join("\n")}\n`, "text/csv");
    this.#record = [];
  }

  /** The open scenario with this set-point and long enough, where what is known is not of that. */
  async #fly(): Promise<void> {
    const { text } = cockpit;
    const end_s = (this.#time.at(-1) ?? 0) - this.#begin_s;
    const asked = `${this.#changes.length} ${this.#begin_s} ${this.flights} ${text}`;
    const isOld = this.#modelOf !== asked || end_s > (this.#model?.time_s.at(-1) ?? 0);
    const isAsFarAsItGoes = this.#modelOf === asked && end_s > LONGEST_S;
    if (!this.#changes.length || this.#isFlying || !isOld || isAsFarAsItGoes || performance.now() - this.#flown < MODEL_MS) return;
    [this.#isFlying, this.#modelOf, this.#flown] = [true, asked, performance.now()];
    const before = this.flights;
    try {
      const found = await flown(text, this.#changes, Math.min(LONGEST_S, Math.max(5, 1.5 * end_s)));
      if (before !== this.flights || found === null) return;
      [this.#model, this.#isDirty] = [typeof found === "string" ? null : found, true];
      if (typeof found === "string") this.modelSays = found;
      else if (this.#changes.length < MOST_CHANGES) this.modelSays = end_s > LONGEST_S ? `The model flies the first ${LONGEST_S} s. "Clear" begins anew.` : "";
    } finally {
      [this.#isFlying, this.#flown] = [false, performance.now()];
    }
  }

  async #draw(): Promise<void> {
    void this.#fly();
    if (this.paused || !this.#isDirty || this.#isDrawing || !this.#time.length) return;
    [this.#isDirty, this.#isDrawing] = [false, true];
    const names = this.#model?.controllers ?? [];
    if (names.length && !names.includes(this.controller)) this.controller = names.includes(cockpit.controller) ? cockpit.controller : names[0]!;
    const of = this.#forgotten;
    try {
      const picture = await this.#pictured();
      // What was cleared or paused meanwhile stays so.
      if (of === this.#forgotten && !this.paused) this.picture = picture;
    } finally {
      this.#isDrawing = false;
    }
  }

  /** What changes the picture beside new lines: another controller, another window. */
  redraw(): void {
    this.#isDirty = true;
  }

  /** The lines of the window, and beside them what the program says of the model there. */
  async #pictured(): Promise<Picture> {
    const last = this.#time.at(-1)!;
    const first = this.window_s ? this.#time.findIndex((at) => at >= last - this.window_s) : 0;
    const cut = (values: number[]) => Float64Array.from(values.slice(first));
    const time_s = cut(this.#time);
    const values = Object.fromEntries([...this.#values].map(([name, list]) => [name, cut(list)]));
    const model = this.#model?.time_s ?? new Float64Array();
    const columns = this.#model?.columns[this.controller];
    // Of the model the samples around the window alone: the question is no longer than the picture.
    const from = Math.max(0, model.findLastIndex((at) => at <= time_s[0]! - this.#begin_s));
    const end = model.findIndex((at) => at >= last - this.#begin_s);
    const part = (column: Float64Array | undefined) => Array.from(column?.slice(from, end < 0 ? undefined : end + 1) ?? []);
    const { json, columns: found } = await cockpit.engine.ask("compare", {
      time_s: Array.from(time_s),
      measured_deg: Array.from(values["measurement_deg"] ?? []),
      begin_s: this.#begin_s,
      model_s: part(model),
      theta_deg: part(columns?.["theta_deg"]),
      command_deg: part(columns?.["command_deg"]),
    });
    const at = (key: string) => found[json[key]] ?? new Float64Array();
    return { time_s, values, model_deg: at("model_deg"), command_deg: at("command_deg"), difference_deg: at("difference_deg"), difference: json.difference ?? null };
  }
}

/** The flight of a text with this set-point; why there is none, in a sentence; null where a newer one was asked for. */
async function flown(text: string, changes: [number, number][], end_s: number): Promise<Model | string | null> {
  const list = (values: number[]) => `[${values.map(float).join(", ")}]`;
  const setpoint = `{ kind = "table", time_s = ${list(changes.map(([at]) => at))}, value_deg = ${list(changes.map(([, value]) => value))} }`;
  let told = text;
  for (const [path, value] of [["setpoint", setpoint], ["loop.duration_s", float(Math.ceil(end_s))]] as const) {
    const { json } = await cockpit.engine.ask("set", { text: told, path, value });
    if (json.text === undefined) return sentence(json);
    told = json.text;
  }
  const found = await cockpit.engine.latest("model", "fly", { text: told });
  if (found === OVERTAKEN) return null;
  if (!found.json.traces) return sentence(found.json);
  const columns = (trace: any) => Object.fromEntries(trace.columns.map((it: any) => [it.name, found.columns[it.at]!]));
  const all: [string, Record<string, Float64Array>][] = found.json.traces.map((trace: any) => [trace.name, columns(trace)]);
  const longest = all.map(([, it]) => it["time_s"]!).reduce((a, b) => (b.length > a.length ? b : a));
  return { controllers: all.map(([name]) => name), time_s: longest, columns: Object.fromEntries(all) };
}

const float = (value: number) => (Number.isInteger(value) ? `${value}.0` : String(value));
const sentence = (json: any) => `The model cannot be flown: ${json.refused ?? json.problems?.[0]?.message ?? "the scenario is not good"}.`;

export const watching = new Watching();
