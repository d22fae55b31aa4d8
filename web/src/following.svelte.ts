// The job that is followed: what its events said so far. It is followed whatever view is open, and found again after a reload.
import { cockpit } from "./cockpit.svelte";
import { Refused, type Event, type Job, type JobKind, type JobState } from "./server";

export interface Trial {
  number: number;
  allowed: boolean;
  cost: number | null;
  violation: number;
  values: number[];
  parameters: number[];
  text?: string | null;
}

/** One controller's share of a summary, as far as the page reads it. */
export interface Spread {
  name: string;
  verdicts: { verdict: string; flights: number }[];
  failed: { count: number; of: number; estimate: number | null; lower: number | null; upper: number | null; at_most: number | null; at_least: number | null };
  measures: Measured[];
  failed_runs: { run: number; severity: string; reasons: string }[];
}

export interface Measured {
  name: string;
  unit: string | null;
  meaning: string;
  count: number;
  missing: number;
  not_finite: number;
  bad: "high" | "low" | null;
  minimum: number | null;
  maximum: number | null;
  quantiles: { share: number; value: number | null }[];
  histogram: { edges: number[]; counts: number[]; below: number; above: number } | null;
  lowest: { run: number; value: number }[];
  highest: { run: number; value: number }[];
}

export interface Envelope {
  name: string;
  time_s: number[];
  setpoint_deg: number[];
  bands: { name: string; lower: (number | null)[]; upper: (number | null)[] }[];
  median: (number | null)[];
  nominal: (number | null)[];
  worst: { run: number; pitch_deg: (number | null)[] }[];
  ended_early: number;
}

export interface Envelopes {
  runs?: number;
  left_out?: number;
  controllers?: Envelope[];
  reason?: string;
}

class Following {
  jobs = $state.raw<Job[]>([]);
  /** Why the list or a job could not be had. */
  refused = $state("");

  job = $state.raw<Job | null>(null);
  state = $state<JobState | "lost" | "">("");
  share = $state(0);
  told = $state("");
  begun = $state.raw<any>(null);
  warnings = $state.raw<string[]>([]);
  /** Events of the beginning that the server does not keep any more. */
  lost = $state(0);
  trials = $state.raw<Trial[]>([]);
  best = $state.raw<Trial | null>(null);
  front = $state.raw<Trial[]>([]);
  rows = $state(0);
  spread = $state.raw<{ runs: number; planned: number; controllers: Spread[]; notes: { text: string }[] } | null>(null);
  envelopes = $state.raw<Envelopes | null>(null);
  result = $state.raw<any>(null);

  #stop: AbortController | null = null;

  get isOn(): boolean {
    return this.state === "waiting" || this.state === "running";
  }

  /** What the jobs of the server are; one that runs on the open scenario is followed. */
  async look(): Promise<void> {
    if (!cockpit.server) return;
    try {
      this.jobs = await cockpit.server.jobs();
      this.refused = "";
    } catch (error) {
      this.refused = words(error);
      return;
    }
    const mine = this.jobs.find((it) => it.scenario === cockpit.id && ["waiting", "running"].includes(it.state));
    if (mine && !this.job) await this.follow(mine);
  }

  async start(kind: JobKind, options: Record<string, unknown>): Promise<void> {
    if (!cockpit.server || !cockpit.id) return;
    try {
      const job = await cockpit.server.start(kind, cockpit.id, options);
      cockpit.live = true;
      await this.follow({ job, kind, scenario: cockpit.id, options, state: "waiting" });
    } catch (error) {
      this.refused = words(error);
    }
  }

  /** Follows a job from its beginning, or what is kept of that. */
  async follow(job: Job): Promise<void> {
    this.#stop?.abort();
    const stop = (this.#stop = new AbortController());
    Object.assign(this, { job, state: job.state, share: 0, told: "", begun: null, warnings: [], lost: 0, refused: "" });
    Object.assign(this, { trials: [], best: null, front: [], rows: 0, spread: null, envelopes: null, result: null });
    void this.#hearAll(job, stop);
  }

  async #hearAll(job: Job, stop: AbortController): Promise<void> {
    try {
      for await (const event of cockpit.server!.job(job.job, stop.signal)) {
        if (stop.signal.aborted) return;
        this.#hear(event);
      }
    } catch (error) {
      if (stop.signal.aborted) return;
      [this.state, this.told] = ["lost", words(error)];
    }
    if (!stop.signal.aborted) await this.look();
  }

  #hear({ event, data }: Event): void {
    const heard = this.#EVENTS[event];
    if (!heard) return;
    if (this.state === "waiting") this.state = "running";
    heard(data);
  }

  readonly #EVENTS: Record<string, (data: any) => void> = {
    begun: (data) => {
      this.begun = data;
      if (data.warnings?.length) this.warnings = [...this.warnings, ...data.warnings];
    },
    warning: (data) => (this.warnings = [...this.warnings, data.text]),
    lost: (data) => (this.lost += data.events),
    progress: (data) => {
      this.share = data.total ? data.done / data.total : 0;
      this.told = data.text;
    },
    candidates: (data) => {
      const found = data.trials.map((trial: Omit<Trial, "number">, at: number) => ({ ...trial, number: data.first + at }));
      this.trials = [...this.trials, ...found];
    },
    best: (data) => this.#better(data),
    front: (data) => (this.front = data.trials),
    rows: (data) => (this.rows += data.rows.length),
    spread: (data) => (this.spread = spreadOf(data)),
    envelope: (data) => (this.envelopes = data),
    done: (data) => {
      [this.state, this.share, this.result] = ["done", 1, data];
      if (this.job?.kind === "campaign") this.spread = spreadOf(data.json);
    },
    failed: (data) => [this.state, this.told] = ["failed", data.reason],
    cancelled: () => (this.state = "cancelled"),
  };

  /** The best so far flies in the place of the person's scenario, which stays as it is. */
  #better(trial: Trial): void {
    this.best = trial;
    if (cockpit.live && trial.text && this.job?.scenario === cockpit.id) void this.fly();
  }

  async fly(): Promise<void> {
    const { best, job } = this;
    if (!best?.text || !job) return;
    const cost = best.cost === null ? "which is not allowed" : `cost ${Number(best.cost.toPrecision(5))}`;
    this.refused = await cockpit.visit(`the best candidate so far of tuning ${job.job}, ${cost}`, best.text);
  }

  /** Flies a run of the campaign in the flight view. */
  async open(run: number): Promise<void> {
    const { job } = this;
    if (!cockpit.server || !job) return;
    try {
      const found = await cockpit.server.run(job.job, run);
      cockpit.show("fly");
      const refused = await cockpit.visit(`run ${run} of campaign ${job.job}: ${found.changes.join(", ")}`, found.text);
      if (refused) cockpit.refused = `run ${run} cannot be flown here: ${refused}`;
    } catch (error) {
      this.refused = words(error);
    }
  }

  async cancel(): Promise<void> {
    try {
      if (this.job) await cockpit.server?.cancel(this.job.job);
    } catch (error) {
      this.refused = words(error);
    }
  }
}

function spreadOf(data: any) {
  return { runs: data.runs, planned: data.planned_runs ?? data.runs, controllers: data.controllers, notes: data.notes ?? [] };
}

function words(error: unknown): string {
  return error instanceof Refused || error instanceof Error ? error.message : String(error);
}

export const following = new Following();
