// Training beside the page: in a worker, with progress, and stopped by an AbortSignal.

/** The bytes of an index file and the notes of training. `clips` are files: `{ bytes, name }`. */
export async function trainInWorker(clips, labels, { background = [], progress, signal, ...options } = {}) {
  signal?.throwIfAborted();
  const file = new URL("./training-worker.js", import.meta.url);
  const node = globalThis.process?.versions?.node;
  const worker = node
    ? new (await import("node:worker_threads")).Worker(file)
    : new Worker(file, { type: "module" });
  try {
    return await new Promise((resolve, reject) => {
      const take = (message) => {
        if (message.ready) worker.postMessage({ clips, background, labels, options });
        else if (message.error !== undefined) reject(new Error(message.error));
        else if (message.bytes) resolve(message);
        else progress?.(message.stage, message.done, message.total);
      };
      if (node) worker.on("message", take).on("error", reject);
      else {
        worker.onmessage = (event) => take(event.data);
        worker.onerror = (event) => reject(new Error(event.message));
      }
      signal?.addEventListener("abort", () => reject(signal.reason));
    });
  } finally {
    worker.terminate();
  }
}
