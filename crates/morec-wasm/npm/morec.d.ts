/** A label: in the clip of that name, the class happens. */
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
  /** Only these classes, in this order. Every class of the labels by default. */
  classes?: string[];
  /** `auto`: each class as its samples say, a gesture or an activity; `templates`: every class as a gesture. `auto` by default. */
  method?: "auto" | "templates";
  /** With the method `auto`: classes that are activities whatever their samples say. */
  activities?: string[];
  /** With the method `auto`: classes that are gestures whatever their samples say. */
  gestures?: string[];
  /** Use of the unlabelled parts of labelled clips. `background` by default. */
  unlabelled?: "background" | "ignore";
  /** Everyday motion that is built in, as background, too; `auto`: if `background` holds less than a minute. `always` by default. */
  everyday?: "auto" | "always" | "never";
  /** Training on mirrored copies of samples, too; `auto`: between classes named as two sides of one motion. `auto` by default. */
  mirror?: "auto" | "yes" | "no";
  /** With the mirror `yes`: classes whose mirror image is another motion. */
  one_sided?: string[];
  /** Body parts to use: `all`, `upper`, `arms`, `hand`, `left_hand`, `hands`, `body_and_hands`, `points3`, or names of bones with commas. */
  bones?: string;
  /** Parameters of the method by their paths: `{ "decode.lag_ticks": 2 }`. */
  params?: Record<string, unknown>;
}

/** Takes a stage, steps done, steps in all; `false` cancels. */
export type ProgressListener = (stage: string, done: number, total: number) => boolean | void;

export interface TrainOptions extends LearnOptions {
  /** Clips that hold none of the classes. */
  background?: Clip[];
  progress?: ProgressListener;
}

export interface RecognizerOptions {
  /** False alarms a minute that background motion may raise: 0.1 is strict, 1 is generous. As trained by default. */
  sensitivity?: number;
  /** The expected performer. `anyone`, or `teacher`: the person who taught. `auto` by default. */
  performer?: "auto" | "teacher" | "anyone";
  /** Report what seems to be under way, too: events of the phases `start`, `update` and `cancel`. False by default. */
  tentative?: boolean;
  /** Make each repetition of an activity an event of its own, of the phase `repetition`. False by default. */
  each_repetition?: boolean;
  /** Say how far from the nearest sample each gesture that ends, and each such repetition, was. False by default. */
  deviation?: boolean;
  /** A motion of the same class that ends less than this after the one before it is not reported, seconds. 0 by default. */
  refractory_secs?: number;
  /** Points that play parts of the body, where names do not tell: `{ left_hand: "LWrist", hips: "LHip+RHip", neck: null }`. */
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
  /** Of an activity that is counted, so far. */
  repetitions?: number;
  /** Seconds of one repetition, as it was last. */
  period_secs?: number;
}

/** The class of a whole clip. */
export interface Classification {
  /** Absent if none of the classes is more probable than everything else. */
  class?: string;
  probability?: number;
  /** The class whose samples are nearest; absent where nothing moves. */
  nearest?: string;
  /** By class; what is missing to 1 is the probability of none of them. */
  probabilities: Record<string, number>;
}

export interface MotionEvent extends Detection {
  /** `end` is final; the others say what seems to be under way. */
  phase: "start" | "update" | "repetition" | "cancel" | "end";
  /** With `deviation`: the mean angle off the nearest sample, the duration over its, and the bone that is farthest off with its largest angle. */
  off_degrees?: number;
  pace?: number;
  worst_bone?: string;
  worst_degrees?: number;
  /** A motion's start, updates and end share its number. */
  motion: number;
  /** Number of the event, from 1. */
  sequence: number;
  /** Number of the performer: 0. */
  actor: number;
  /** Share of the motion that has been seen. */
  progress: number;
  /** Wall clock at the arrival of the frame that settled it: seconds since 1970. */
  wall_secs: number;
}

/** x, y, z of each point; not a number where it is not seen. */
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
  /** Repairs and oddities, a sentence each. */
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
  /** The bytes of its file, the same as the command's. */
  toBytes(): Uint8Array;
  readonly classes: string[];
  /** What training said about its material, a sentence each. */
  readonly notes: string[];
  /** The index with thresholds for this many false alarms a minute. */
  withSensitivity(alarms_per_minute: number): Index;
  /** The detections in a clip, as of a live stream. */
  recognize(clip: Clip): Detection[];
  /** The class of a whole clip that was cut around one motion. */
  classify(clip: Clip): Classification;
  /** A recogniser of a stream of points: a published set's names, usual joint names, or `roles()`. */
  recognizer(points: string[], options?: RecognizerOptions): Recognizer;
  free(): void;
}

/** One performer's stream. */
export class Recognizer {
  private constructor();
  /** Takes a frame; the events that it settled, mostly none. */
  push(time_secs: number, positions: Positions): readonly MotionEvent[];
  /** Ends the stream; the next frame begins a new one. */
  finish(): readonly MotionEvent[];
  /** What is wrong with the stream of the last seconds for the index, a sentence each with its severity and what to do. */
  diagnosis(): string[];
  /** Seconds from the end of a motion to its report at the earliest. */
  readonly latency_secs: number;
  free(): void;
}

/** The one clip in the bytes of a file; its name says the format where the bytes do not. */
export function read(bytes: Uint8Array, name: string): Clip;
/** All clips in the bytes of a file. */
export function readAll(bytes: Uint8Array, name: string): Clip[];
/** Trains an index; `labels` is the text of a table or rows. */
export function train(clips: Clip[], labels: string | LabelRow[], options?: TrainOptions): Index;
/** Names of the parts of the body. */
export function roles(): string[];
export function version(): string;
