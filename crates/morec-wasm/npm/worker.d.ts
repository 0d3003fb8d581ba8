import type { LabelRow, LearnOptions } from "./morec.js";

/** A clip file. */
export interface ClipFile {
  bytes: Uint8Array;
  name: string;
}

export interface WorkerOptions extends LearnOptions {
  /** Files that hold none of the classes. */
  background?: ClipFile[];
  progress?: (stage: string, done: number, total: number) => void;
  /** Stops the training. */
  signal?: AbortSignal;
}

/** Trains in a worker: the bytes of the index file (`Index.fromBytes` reads them), and what training said. */
export function trainInWorker(
  clips: ClipFile[],
  labels: string | LabelRow[],
  options?: WorkerOptions,
): Promise<{ bytes: Uint8Array; notes: string[] }>;
