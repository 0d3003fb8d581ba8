/** A label: a stretch of a clip that shows a class. */
export interface LabelRow {
  /** Name of the clip. */
  clip: string;
  class: string;
  /** Both or neither: without them the whole clip is one sample. */
  start_secs?: number;
  stop_secs?: number;
  person?: string;
}

/** Settings of training, those of `morec train`. */
export interface LearnOptions {
  /** Learn only these classes, in this order. All classes of the labels by default. */
  classes?: string[];
  /** `auto`: each class as a gesture or an activity, as its samples show; `templates`: every class as a gesture. `auto` by
  default. */
  method?: "auto" | "templates";
  /** With the method `auto`: classes that are activities, whatever their samples show. */
  activities?: string[];
  /** With the method `auto`: classes that are gestures, whatever their samples show. */
  gestures?: string[];
  /** Use of the unlabelled parts of labelled clips. `background` by default. */
  unlabelled?: "background" | "ignore";
  /** Use the built-in everyday motion as background; `auto`: only if `background` has less than 1 minute. `always` by default. */
  everyday?: "auto" | "always" | "never";
  /** Train on mirrored copies of samples too; `auto`: between pairs of classes named for a side. `auto` by default. */
  mirror?: "auto" | "yes" | "no";
  /** With the mirror `yes`: classes whose mirror image is another motion. */
  one_sided?: string[];
  /** Body parts to use: `all`, `upper`, `arms`, `hand`, `left_hand`, `hands`, `body_and_hands`, `points3`, or names of bones with commas. */
  bones?: string;
  /** Parameters of the method by their paths: `{ "decode.lag_ticks": 2 }`. */
  params?: Record<string, unknown>;
}

/** Receives the stage, the steps done and the total; returning `false` cancels. */
export type ProgressListener = (stage: string, done: number, total: number) => boolean | void;

export interface TrainOptions extends LearnOptions {
  /** Clips without any class; they set the detection threshold. */
  background?: Clip[];
  progress?: ProgressListener;
}

export interface RecognizerOptions {
  /** Accepted false alarms a minute in background motion: 0.1 is strict, 1 is generous. As trained by default. */
  sensitivity?: number;
  /** The expected performer: `teacher` is the training subject. `auto` by default. */
  performer?: "auto" | "teacher" | "anyone";
  /** Also report motions before they end: events of the phases `start`, `update` and `cancel`. False by default. */
  tentative?: boolean;
  /** Make each repetition of an activity an event of its own, of the phase `repetition`. False by default. */
  each_repetition?: boolean;
  /** Say how far from the nearest sample each gesture that ends, and each such repetition, was. False by default. */
  deviation?: boolean;
  /**
   * Report with each frame how far every class has come: events of the phase `progress`, whose `progress` and `score` are how far and how
   * like to a sample, both 0 to 1, and whose `motion` is 0. False by default.
   */
  progress?: boolean;
  /** A motion of the same class that ends less than this after the one before it is not reported, seconds. 0 by default. */
  refractory_secs?: number;
  /** Points of body parts that the names do not identify: `{ left_hand: "LWrist", hips: "LHip+RHip", neck: null }`. */
  roles?: Record<string, string | null>;
  /** The axis that points up; `-y` for landmarks of pictures. `y` by default. */
  up?: "x" | "y" | "z" | "-x" | "-y" | "-z";
}

/** Times are seconds. */
export interface Detection {
  class: string;
  start_secs: number;
  stop_secs: number;
  /**
   * Probability that the detection is right, 0 to 1. The lowest accepted score is 0.05 to 0.44, depending on the index. For held
   * poses and indexes without calibration (svrdm, older files) it is the similarity to a sample instead. Of a tentative event:
   * how near what was seen so far is to the beginning of a sample, 0 to 1.
   */
  score: number;
  reported_secs: number;
  /** Repetitions of an activity so far. */
  repetitions?: number;
  /** Duration of the last repetition, seconds. */
  period_secs?: number;
}

/** The class of a whole clip. */
export interface Classification {
  /** Absent if no class is more probable than all alternatives together. */
  class?: string;
  probability?: number;
  /** The class of the nearest samples; absent if nothing moves. */
  nearest?: string;
  /** Probability of each class; the rest to 1 is the probability of none of them. */
  probabilities: Record<string, number>;
}

export interface MotionEvent extends Detection {
  /** `end` is final; the others say what seems to be under way. */
  phase: "start" | "update" | "repetition" | "progress" | "cancel" | "end";
  /** With `deviation`, or of the phase `progress`: the duration over that of the nearest sample, so far. */
  pace?: number;
  /** With `deviation`: the mean angle off the nearest sample, and the bone that is farthest off with its largest angle. */
  off_degrees?: number;
  worst_bone?: string;
  worst_degrees?: number;
  /** Number of the motion, shared by its start, updates and end. */
  motion: number;
  /** Number of the event, from 1. */
  sequence: number;
  /** Number of the performer: 0. */
  actor: number;
  /** Share of the motion that has been seen. */
  progress: number;
  /** Wall clock when the deciding frame arrived, seconds since 1970. */
  wall_secs: number;
}

/** x, y, z of each point; NaN if a point is missing. */
export type Positions = Float32Array | Float64Array | number[];

/** A clip in metres, Y up. */
export class Clip {
  private constructor();
  /** A clip of named points, frame by frame. */
  static fromPositions(name: string, points: string[], rate_hz: number, positions: Positions, frames: number, up?: string): Clip;
  readonly name: string;
  readonly frames: number;
  readonly rate_hz: number;
  readonly duration_secs: number;
  /** Repairs and doubts of reading, one sentence each. */
  readonly warnings: string[];
  /** Time of every frame, seconds. */
  times(): Float64Array;
  /** x, y, z of each of `roles()`, frame by frame. */
  positions(): Float64Array;
  free(): void;
}

/** A trained index. */
export class Index {
  private constructor();
  static fromBytes(bytes: Uint8Array): Index;
  /** The bytes of the index file, as the command writes it. */
  toBytes(): Uint8Array;
  readonly classes: string[];
  /** Notes of training about its clips and labels, one sentence each. */
  readonly notes: string[];
  /** The index with thresholds for this many false alarms a minute. */
  withSensitivity(alarms_per_minute: number): Index;
  /** Recognises motions in a clip, as in a live stream. */
  recognize(clip: Clip): Detection[];
  /** Classifies a whole clip that contains one motion. */
  classify(clip: Clip): Classification;
  /** A recogniser for a stream of points with names of a published set, usual joint names, or `roles()`. */
  recognizer(points: string[], options?: RecognizerOptions): Recognizer;
  free(): void;
}

/** One performer's stream. */
export class Recognizer {
  private constructor();
  /** Processes a frame; returns the events that it causes, usually none. */
  push(time_secs: number, positions: Positions): readonly MotionEvent[];
  /** Ends the stream and returns its last events; the next frame starts a new stream. */
  finish(): readonly MotionEvent[];
  /** Problems of the stream in the last seconds, one sentence each with severity and remedy. */
  diagnosis(): string[];
  /** Shortest time from the end of a motion to its report, seconds. */
  readonly latency_secs: number;
  free(): void;
}

/** Reads the only clip in the bytes of a file; the name's extension gives the format if the bytes do not. */
export function read(bytes: Uint8Array, name: string): Clip;
/** Reads all clips in the bytes of a file. */
export function readAll(bytes: Uint8Array, name: string): Clip[];
/** Trains an index; `labels` is the text of a table or rows. */
export function train(clips: Clip[], labels: string | LabelRow[], options?: TrainOptions): Index;
/** Names of the body parts (roles). */
export function roles(): string[];
export function version(): string;
