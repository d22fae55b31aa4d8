// Shapes of the answers, as far as the page reads them.

/** A place of a scenario that can be changed: a row of `fspid check --paths --format json`. */
export interface Place {
  path: string;
  value: unknown;
  unit: string;
  allowed: string;
  schema: { type?: string; enum?: string[]; minimum?: number; maximum?: number; exclusiveMinimum?: number; exclusiveMaximum?: number };
  given: boolean;
}

export interface ControllerSummary {
  name: string;
  kind: "fixed" | "self-tuning" | "external";
  path: string | null;
}

export interface Summary {
  name: string;
  digest: string;
  warnings: string[];
  controllers: ControllerSummary[];
  sample_period_s: number;
  duration_s: number;
  requirements: { id: string; measure: string; controller: string | null; limits: string }[];
  paths: Place[];
  /** What the page writes a controller as. */
  targets: string[];
}

export interface Problem {
  line: number | null;
  column: number | null;
  origin: string | null;
  path: string;
  found: string;
  message: string;
  allowed: string;
}

export interface Trace {
  name: string;
  good: boolean;
  notes: string[];
  columns: Record<string, Float64Array>;
}

export interface ControllerAnswer {
  name: string;
  verdict: string;
  outcome: { kind: string };
  failed: boolean;
  failures?: string[];
  metrics: Record<string, number | null>;
  absent: Record<string, string>;
  saturated_samples: number;
  faults: string;
}

export interface Judgement {
  id: string;
  controller: string;
  measure: string;
  met: boolean;
  least?: number;
  most?: number;
  value?: number | string;
  reason?: string;
  absent?: string;
}

export interface Flight {
  /** The text that flew. */
  of: string;
  controllers: ControllerAnswer[];
  requirements: Judgement[];
  notes: string[];
  met: boolean;
  failed: boolean;
  traces: Trace[];
}

export interface Curve {
  name: string;
  columns: Record<string, Float64Array>;
}

export interface Judged {
  analysis: any;
  held: boolean;
  loops: Curve[];
  poles: Curve[];
}

export interface Shape {
  controller: string;
  path: string;
  named_table: string | null;
  range: number;
  labels: string[];
  centres: Record<"error" | "change", { small: number; medium: number; even: boolean }>;
  rules: { are_labels: boolean; is_network: boolean; grids: Record<string, (string | number)[][]> };
  odd: { grid: string; cell: [number, number]; opposite: [number, number] }[];
  /** What the program's audit says of the cells of each grid. */
  audit: {
    grid: string;
    words: string;
    holes: [number, number][];
    along: { input: "error" | "change"; words: string; exceptions: [[number, number], [number, number]][] }[];
  }[];
  visits: number[][];
  inputs: Float64Array;
  grades: Record<"error" | "change", Float64Array[]>;
}

export interface Fired {
  cell: [number, number];
  error: string;
  change: string;
  strength: number;
  words: string;
  kp: Added | null;
  ki: Added | null;
  kd: Added | null;
}

export interface Added {
  label: string;
  added: number | string | null;
}

export interface Moment {
  controller: string;
  at_s: number;
  setpoint_deg: number;
  measurement_deg: number;
  rate_deg_s: number;
  command_deg: number;
  command_before_limits_deg: number;
  saturated: boolean;
  parts: Record<"proportional_deg" | "integral_deg" | "derivative_deg" | "rate_deg" | "fed_forward_deg", number>;
  gains: Record<"nominal" | "used", Record<"kp" | "ki" | "kd", number>>;
  supervisor?: {
    error: number;
    change: number;
    error_grades: number[];
    change_grades: number[];
    increments: Record<"kp" | "ki" | "kd", number>;
    rules: Fired[];
  };
}
