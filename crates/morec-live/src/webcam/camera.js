// The camera and films by MediaPipe, for `web/` and for `--listen webcam`. A source is a function `(take, signal) → Promise` that calls
// `take(secs, positions, landmarks)` for each pose until the signal is aborted or the source ends: places of parts of the body by name,
// metres, Y up; landmarks (x, y from 0 to 1) for drawing.

/** MediaPipe's landmarks whose middle is the joint; those of docs/guide/devices.md. */
const PARTS = {
  hips: [23, 24], neck: [11, 12], head: [7, 8],
  left_arm: [11], left_forearm: [13], left_hand: [15],
  right_arm: [12], right_forearm: [14], right_hand: [16],
  left_thigh: [23], left_shin: [25], left_foot: [27],
  right_thigh: [24], right_shin: [26], right_foot: [28],
};

/** Lines between landmarks, for drawing. */
const LINES = [
  [11, 12], [11, 13], [13, 15], [12, 14], [14, 16], [11, 23], [12, 24], [23, 24], [23, 25], [25, 27], [24, 26], [26, 28],
];

/** Places of the parts that MediaPipe's world landmarks show: theirs have Y down and Z away from the camera. */
export function partsOf(world) {
  const positions = {};
  for (const [part, numbers] of Object.entries(PARTS)) {
    const marks = numbers.map((number) => world[number]);
    if (marks.some((mark) => !mark || (mark.visibility ?? 1) <= 0.5)) continue;
    const middle = (axis) => marks.reduce((sum, mark) => sum + mark[axis], 0) / marks.length;
    positions[part] = [middle("x"), -middle("y"), -middle("z")];
  }
  return positions;
}

/** What plays in `video`, by MediaPipe's pose; `folder` has the files of the npm package `@mediapipe/pose`. */
export const pictures = (video, folder) => async (take, signal) => {
  const pose = await landmarker(folder);
  try {
    let secs = 0;
    pose.onResults(({ poseLandmarks, poseWorldLandmarks }) => {
      if (poseWorldLandmarks && !signal.aborted) take(secs, partsOf(poseWorldLandmarks), poseLandmarks);
    });
    let last = -1;
    while (!signal.aborted && !video.ended) {
      if (video.readyState >= 2 && video.currentTime !== last) {
        last = video.currentTime;
        secs = performance.now() / 1000;
        await pose.send({ image: video });
      }
      await new Promise(requestAnimationFrame);
    }
  } finally {
    await pose.close();
  }
};

/** The camera, shown in `video`. */
export const camera = (video, folder) => async (take, signal) => {
  const stream = await navigator.mediaDevices.getUserMedia({ video: { width: 640, height: 480 }, audio: false });
  try {
    video.srcObject = stream;
    await video.play();
    await pictures(video, folder)(take, signal);
  } finally {
    stream.getTracks().forEach((track) => track.stop());
    video.srcObject = null;
  }
};

/** A film. */
export const film = (video, folder, file) => async (take, signal) => {
  video.src = URL.createObjectURL(file);
  try {
    await video.play();
    await pictures(video, folder)(take, signal);
  } finally {
    URL.revokeObjectURL(video.src);
    video.removeAttribute("src");
    video.load();
  }
};

async function landmarker(folder) {
  if (!globalThis.Pose) {
    await new Promise((loaded, failed) => {
      const script = document.createElement("script");
      script.src = `${folder}/pose.js`;
      script.crossOrigin = "anonymous";
      script.onload = loaded;
      script.onerror = () => failed(new Error(`MediaPipe is not in ${folder}.`));
      document.head.append(script);
    });
  }
  const pose = new globalThis.Pose({ locateFile: (file) => `${folder}/${file}` });
  pose.setOptions({ modelComplexity: 1, smoothLandmarks: true });
  return pose;
}

/** The landmarks over the picture in `video`. */
export function drawLandmarks(drawing, video, landmarks) {
  const { canvas } = drawing;
  const scale = Math.min(canvas.width / video.videoWidth, canvas.height / video.videoHeight);
  const [width, height] = [video.videoWidth * scale, video.videoHeight * scale];
  const place = ({ x, y }) => [(canvas.width - width) / 2 + x * width, (canvas.height - height) / 2 + y * height];
  drawing.beginPath();
  for (const [from, to] of LINES) {
    drawing.moveTo(...place(landmarks[from]));
    drawing.lineTo(...place(landmarks[to]));
  }
  drawing.stroke();
}
