// The camera and films by MediaPipe, for `web/` and for `--listen webcam`. A source is a function `(take, signal) → Promise` that calls
// `take(secs, positions, seen)` for each pose until the signal is aborted or the source ends: places of parts by name, metres, Y up; what
// `drawLandmarks` draws.
import { tracker } from "./mediapipe.js";
import { devices } from "./words.js";

/** What plays in `video`: `what` MediaPipe, whose files are in `folder`, tracks of it. */
const pictures = (video, folder, what) => async (take, signal) => {
  const { track, close } = await tracker(folder, what);
  try {
    let last = -1;
    while (!signal.aborted && !video.ended) {
      if (video.readyState >= 2 && video.currentTime !== last) {
        last = video.currentTime;
        const secs = performance.now() / 1000;
        const seen = await track(video);
        if (seen && !signal.aborted) take(secs, seen.positions, seen);
      }
      await new Promise(requestAnimationFrame);
    }
  } finally {
    await close();
  }
};

/** The camera, shown in `video`. */
export const camera = (video, folder, what) => async (take, signal) => {
  const stream = await devices().getUserMedia({ video: { width: 640, height: 480 }, audio: false });
  try {
    video.srcObject = stream;
    await video.play();
    await pictures(video, folder, what)(take, signal);
  } finally {
    stream.getTracks().forEach((track) => track.stop());
    if (video.srcObject === stream) video.srcObject = null;
  }
};

/** A film. */
export const film = (video, folder, what, file) => async (take, signal) => {
  video.src = URL.createObjectURL(file);
  try {
    await video.play();
    await pictures(video, folder, what)(take, signal);
  } finally {
    URL.revokeObjectURL(video.src);
    video.removeAttribute("src");
    video.load();
  }
};

/** Jobs of which one runs at a time: a new one ends the one before, and begins when that has ended. A job is given a signal to end. */
export function inTurn() {
  let own = new AbortController();
  let ended = Promise.resolve();
  return {
    stop: () => own.abort(),
    run(job) {
      own.abort();
      const { signal } = (own = new AbortController());
      const turn = ended.then(() => (signal.aborted ? undefined : job(signal)));
      ended = turn.catch(() => {});
      return turn;
    },
  };
}

/** The landmarks over the picture in `video`. */
export function drawLandmarks(drawing, video, seen) {
  const { canvas } = drawing;
  const scale = Math.min(canvas.width / video.videoWidth, canvas.height / video.videoHeight);
  const [width, height] = [video.videoWidth * scale, video.videoHeight * scale];
  const place = ({ x, y }) => [(canvas.width - width) / 2 + x * width, (canvas.height - height) / 2 + y * height];
  drawing.beginPath();
  for (const landmarks of seen.pictures) {
    for (const [from, to] of seen.lines) {
      drawing.moveTo(...place(landmarks[from]));
      drawing.lineTo(...place(landmarks[to]));
    }
  }
  drawing.stroke();
}
