// morec for JavaScript. Importing it loads the WebAssembly module beside it; everything is ready after that.
import init, { Clip, Index, Recognizer, Training, initSync, readAll, roles, version } from "./wasm/morec.js";

const file = new URL("./wasm/morec_bg.wasm", import.meta.url);
if (file.protocol === "file:" && globalThis.process?.versions?.node) {
  const { readFile } = await import("node:fs/promises");
  initSync({ module: await readFile(file) });
} else {
  await init({ module_or_path: file });
}

export { Clip, Index, Recognizer, readAll, roles, version };

/** The one clip in the bytes of a file. */
export function read(bytes, name) {
  const clips = readAll(bytes, name);
  if (clips.length !== 1) {
    throw new Error(`${name}: expected one clip, found ${clips.length}; readAll gives them all, ${name}#2 the second`);
  }
  return clips[0];
}

/** Trains an index. It takes a second or more: `morec/worker` does it beside the page. */
export function train(clips, labels, options = {}) {
  const { progress, background = [], ...rest } = options;
  const training = new Training();
  try {
    for (const clip of clips) training.add(clip);
    for (const clip of background) training.addBackground(clip);
    return training.train(labels, rest, progress);
  } finally {
    training.free();
  }
}
