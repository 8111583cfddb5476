// The API as the page sees it (docs: /api/v1/openapi.json). Optional members are left out by the server, never null.

export type MachineState =
  'Unknown' | 'Idle' | 'Run' | 'Hold' | 'Jog' | 'Home' | 'Alarm' | 'Check' | 'Door' | 'Sleep' | 'Tool';
export type LinkPhase = 'Off' | 'Opening' | 'Greeting' | 'Ready' | 'Silent' | 'Lost';
export type JobPhase =
  | 'Running'
  | 'Holding'
  | 'Held'
  | 'Draining'
  | 'Stopping'
  | 'Finished'
  | 'Refused'
  | 'Alarmed'
  | 'Interrupted'
  | 'Stopped';

export interface Link {
  phase: LinkPhase;
  sentence: string;
  since_s?: number;
  silent_for_s?: number;
  round_trip_s?: number;
}

export interface Inputs {
  limits: string;
  other: string;
  [name: string]: boolean | string;
}

export interface Snapshot {
  state: MachineState;
  substate?: number;
  odd_state?: string;
  machine_position_mm?: number[];
  work_position_mm?: number[];
  work_offset_mm?: number[];
  feed_mm_per_min?: number;
  spindle_rpm?: number;
  overrides?: { feed: number; rapid: number; spindle: number };
  accessories?: { spindle: 'Off' | 'Clockwise' | 'Counterclockwise'; flood: boolean; mist: boolean };
  inputs?: Inputs;
  work_coordinate_system?: string;
  tool?: number;
  homing?: { all?: boolean; axes?: string; is_told?: boolean };
  pendant_in_control?: boolean;
  offsets_mm?: Record<string, number[]>;
  alarm_code?: number;
  reset_required?: boolean;
  messages?: { kind?: string; text: string; at?: number }[];
  prompt?: string;
  reported_at?: number;
  reports?: number;
}

export interface Limits {
  axes: string;
  min_mm?: number[];
  max_mm?: number[];
  max_feed_mm_per_min?: number[];
  homing_enabled?: boolean;
  soft_limits?: boolean;
  laser_mode?: boolean;
  spindle_max_rpm?: number;
  spindle_min_rpm?: number;
}

export interface JobView {
  number?: number;
  program: string;
  program_id?: string;
  phase: JobPhase;
  hold_cause: string;
  progress: {
    lines_total: number;
    lines_acknowledged: number;
    file_line: number;
    cutting_line?: number;
    executing?: { from: number; to: number; known_by: string };
    percent: number;
    elapsed_s: number;
    held_s?: number;
    remaining_s?: number;
  };
  tool_change?: { file_line: number; tool?: number; by_operator: boolean };
  refusal?: { file_line: number; text: string; code: number; meaning: string };
  alarm_code?: number;
  position_suspect?: boolean;
  reason?: string;
}

export type Action =
  | 'start'
  | 'hold'
  | 'resume'
  | 'stop'
  | 'abort'
  | 'jog'
  | 'home'
  | 'unlock'
  | 'send_line'
  | 'change_settings'
  | 'overrides';

export interface Note {
  number: number;
  at: string;
  level: 'Note' | 'Warning' | 'Trouble';
  sentence: string;
}

export interface InterruptedJob {
  job: number;
  program: string;
  ended: string;
  line: number;
  lines: number;
  reason: string;
}

export interface Trouble {
  kind: string;
  headline: string;
  evidence?: string[];
  steps?: string[];
}

export interface Preparation {
  phase: 'Checking' | 'Rehearsing' | 'Settling' | 'Asking';
  sentence: string;
  question?: string;
  told?: string[];
}

export interface MachineView {
  name: string;
  url: string;
  is_virtual?: boolean;
  link: Link;
  busy?: string;
  snapshot?: Snapshot;
  limits?: Limits;
  firmware?: { name: string; version: string; build: string };
  job?: JobView;
  program?: string;
  preparation?: Preparation;
  trouble?: Trouble;
  notes?: Note[];
  can?: Partial<Record<Action, string>>;
  jog?: { lease?: string };
  interrupted?: InterruptedJob[];
}

export interface ProgramView {
  name: string;
  bytes: number;
  lines: number;
  added_at: string;
  example?: boolean;
}

export interface StateDocument {
  server: { name: string; version: string; started_at: string; roles?: string };
  machines: Record<string, MachineView>;
  programs: Record<string, ProgramView>;
}

export interface Answer {
  type: 'answer';
  key: string;
  outcome: 'Accepted' | 'Refused' | 'Invalid';
  reason?: string;
  sentence?: string;
}

export interface TrafficLine {
  number: number;
  at_s: number;
  direction: 'Sent' | 'Received';
  text: string;
  meaning?: string;
  purpose?: string;
}

export type ServerFrame =
  | { type: 'hello'; client: string; clock_s: number; number: number }
  | { type: 'snapshot'; number: number; clock_s: number; state: StateDocument }
  | { type: 'patch'; number: number; clock_s: number; patch: unknown }
  | Answer
  | { type: 'traffic'; machine: string; lines: TrafficLine[] };

export type AxisDirection = Partial<Record<string, number>>;

export interface Setting {
  id: string;
  value: string;
  name: string;
  unit: string;
  group_id: number;
  group: string;
  type: number;
  type_name: string;
  format: string;
  min: string;
  max: string;
  reboot_required: boolean;
  allow_null: boolean;
  help: string;
  meaning: string;
  range: string;
}

export interface SettingGroup {
  id: number;
  parent?: number;
  name: string;
}

export interface SettingsVersion {
  number: number;
  taken: string;
  reason: string;
}

export interface CodeFact {
  id: number;
  title: string;
  text: string;
}

export interface Finding {
  line: number;
  text: string;
  severity: 'Error' | 'Warning' | 'Note';
  what: string;
  reason: string;
  next: string;
}

export interface CheckResult {
  worst?: string;
  errors: number;
  warnings: number;
  notes: number;
  lines: number;
  findings: Finding[];
  extents?: { axis: string; min_mm: number; max_mm: number }[];
}

export interface Estimate {
  total_s: number;
  grade?: string;
  use?: Record<string, number>;
  timeline?: { lines: number[]; end_s: number[] };
}

export interface Port {
  url: string;
  title: string;
  kind: 'Serial' | 'Virtual' | 'Network';
  in_use_by?: string;
}

export interface JournalEntry {
  job: number;
  program: string;
  program_id?: string;
  started_at: string;
  ended_at?: string;
  /** Complete, CutOff, … */
  /** Not while it runs. */
  outcome?: string;
  lines_acknowledged: number;
  lines_total: number;
  reason?: string;
  resumable?: boolean;
}
