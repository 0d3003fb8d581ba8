// Where poses come from: the camera or a film through MediaPipe (`camera.js`), or recorded lines of JSON. A source is a function
// `(take, signal) → Promise` that calls `take(secs, positions, seen)` for each pose until the signal is aborted or the source ends:
// places of parts of body and hands by name, metres, Y up; what `drawLandmarks` draws, if there is a picture.
import { posesOf } from "./teaching.js";

export { camera, drawLandmarks, film, inTurn } from "./vendor/camera.js";
export { inWords } from "./vendor/words.js";
export { handsOf, partsOf } from "./vendor/mediapipe.js";

const aborted = (signal) => new Promise((done) => signal.addEventListener("abort", done, { once: true }));

/** Recorded poses, at their own pace or, for tests, at once. */
export const recorded = (text, { atOnce = false } = {}) => async (take, signal) => {
  const poses = posesOf(text);
  const begun = performance.now();
  for (const { t, positions } of poses) {
    const early = atOnce ? 0 : (t - poses[0].t) * 1000 - (performance.now() - begun);
    if (early > 0) await Promise.race([new Promise((done) => setTimeout(done, early)), aborted(signal)]);
    if (signal.aborted) return;
    take(t, positions);
  }
};
