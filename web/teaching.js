// What the page does, without the page: samples, training, recognition. Tested in Node.

/** Seconds of poses that are kept, for cutting a sample out of what just happened. */
const KEPT_SECS = 20;
/** Least seconds of a sample. */
const LEAST_SECS = 0.5;

/**
 * Teaches and recognises. Poses go in with `pose`; out come DOM events: `motion` (detail: an event of morec), `change` (samples or
 * index are others), `diagnosis` (detail: sentences).
 */
export class Teaching extends EventTarget {
  samples = [];
  index = null;
  #morec;
  #roles;
  #train;
  #recent = [];
  #recording = null;
  #undone = [];
  #recognizer = null;
  #row = null;
  #diagnosed = 0;

  /** `morec` is the package, `train` its `trainInWorker` or a function like it. */
  constructor(morec, train) {
    super();
    this.#morec = morec;
    this.#roles = morec.roles();
    this.#train = train;
  }

  /** Takes a pose: seconds, and the places of parts of the body by name, metres, Y up. */
  pose(t, positions) {
    const pose = { t, positions };
    // A source that begins anew has a clock of its own.
    if (this.#recent.length > 0 && t < this.#recent.at(-1).t) this.#recent = [];
    this.#recent.push(pose);
    while (this.#recent[0].t < t - KEPT_SECS) this.#recent.shift();
    this.#recording?.push(pose);
    if (!this.index) return;
    this.#recognizer ??= this.#begin();
    if (!this.#recognizer) return;
    this.#row.fill(NaN);
    this.#roles.forEach((role, at) => {
      if (positions[role]) this.#row.set(positions[role], 3 * at);
    });
    for (const event of this.#recognizer.push(t, this.#row)) this.#emit("motion", event);
    if (Math.abs(t - this.#diagnosed) >= 1) {
      this.#diagnosed = t;
      this.#emit("diagnosis", this.#recognizer.diagnosis());
    }
  }

  /** Ends the stream: what its last moments hold is reported. */
  finish() {
    for (const event of this.#recognizer?.finish() ?? []) this.#emit("motion", event);
    this.#forget();
  }

  /** A recogniser; null if the index is of another performer, which is said. */
  #begin() {
    this.#row = new Float32Array(3 * this.#roles.length);
    try {
      return this.index.recognizer(this.#roles, { tentative: true });
    } catch (error) {
      this.#emit("diagnosis", [String(error.message ?? error)]);
      return null;
    }
  }

  #forget() {
    this.#recognizer?.free();
    this.#recognizer = null;
  }

  #emit(type, detail) {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }

  /** True if there are last seconds to `cut` from. */
  get hasPoses() {
    return this.#recent.length > 0;
  }

  /** Begins a sample. */
  record() {
    this.#recording = [];
  }

  /** Ends it: the sample of `name`. Training leaves out the stillness around the movement. */
  keep(name) {
    const poses = this.#recording ?? [];
    this.#recording = null;
    return this.add(name, poses);
  }

  /** A sample of `name` from the last seconds. */
  cut(name, secs) {
    const end = this.#recent.at(-1)?.t ?? 0;
    return this.add(name, this.#recent.filter((pose) => pose.t >= end - secs));
  }

  /** Adds a sample of poses. */
  add(name, poses) {
    if (!name.trim()) throw new Error("The motion needs a name.");
    const secs = poses.length > 0 ? poses.at(-1).t - poses[0].t : 0;
    if (secs < LEAST_SECS) throw new Error("No person was tracked. Check that the whole movement is in the picture.");
    const sample = { class: name.trim(), poses };
    this.#change(() => this.samples.push(sample));
    return sample;
  }

  remove(sample) {
    this.#change(() => (this.samples = this.samples.filter((other) => other !== sample)));
  }

  rename(from, to) {
    if (!to.trim()) throw new Error("The motion needs a name.");
    const renamed = (sample) => (sample.class === from ? { ...sample, class: to.trim() } : sample);
    this.#change(() => (this.samples = this.samples.map(renamed)));
  }

  get canUndo() {
    return this.#undone.length > 0;
  }

  undo() {
    const before = this.#undone.pop();
    if (!before) return;
    this.samples = before;
    this.#emit("change");
  }

  #change(change) {
    this.#undone.push([...this.samples]);
    change();
    this.#emit("change");
  }

  /** The samples of each motion, by its name. */
  classes() {
    const classes = new Map();
    for (const sample of this.samples) classes.set(sample.class, [...(classes.get(sample.class) ?? []), sample]);
    return classes;
  }

  /** Trains on the samples; the notes of the training. */
  async train(options = {}) {
    const files = this.samples.map((sample, at) => ({
      name: `sample_${at + 1}.jsonl`,
      bytes: new TextEncoder().encode(linesOf(sample.poses)),
    }));
    const labels = this.samples.map((sample, at) => ({ clip: `sample_${at + 1}`, class: sample.class }));
    const { bytes, notes } = await this.#train(files, labels, options);
    this.load(bytes);
    return notes;
  }

  /** Recognises with the bytes of an index file: the page's own, the studio's or the command's. */
  load(bytes) {
    const index = this.#morec.Index.fromBytes(bytes);
    this.#forget();
    this.index?.free();
    this.index = index;
    this.#emit("change");
  }

  /** The samples as text; `restore` reads it. */
  saved() {
    return JSON.stringify({ morec_samples: 1, samples: this.samples });
  }

  restore(text) {
    const samples = samplesOf(text);
    this.#change(() => (this.samples = samples));
  }

  /** Begins with samples that were saved: nothing was there before them that could come back. */
  begin(text) {
    this.samples = samplesOf(text);
    this.#undone = [];
    this.#emit("change");
  }
}

/** The samples of a saved text. */
function samplesOf(text) {
  const { morec_samples: version, samples } = JSON.parse(text);
  if (version !== 1 || !Array.isArray(samples)) throw new Error("This file does not contain samples.");
  return samples;
}

/** Poses as lines of JSON, which morec reads as a clip. */
export const linesOf = (poses) => poses.map((pose) => JSON.stringify(pose)).join("\n");

/** Poses of lines of JSON. */
export function posesOf(text) {
  const poses = text.split("\n").filter((line) => line.trim()).map((line) => JSON.parse(line));
  return poses.map(({ t, positions }, at) => ({ t: t ?? at / 30, positions }));
}
