// Trains in a thread of its own; `worker.js` talks to it.
import { read, train } from "./morec.js";

const port = globalThis.process?.versions?.node
  ? (await import("node:worker_threads")).parentPort
  : globalThis;
const listen = port.on ? (take) => port.on("message", take) : (take) => port.addEventListener("message", (e) => take(e.data));

listen(({ clips, background, labels, options }) => {
  try {
    const opened = (files) => files.map(({ bytes, name }) => read(bytes, name));
    const progress = (stage, done, total) => port.postMessage({ stage, done, total });
    const index = train(opened(clips), labels, { ...options, background: opened(background), progress });
    port.postMessage({ bytes: index.toBytes(), notes: index.notes });
  } catch (error) {
    port.postMessage({ error: String(error?.message ?? error) });
  }
});
port.postMessage({ ready: true });
