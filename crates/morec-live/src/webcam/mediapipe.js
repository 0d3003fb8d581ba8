// What MediaPipe sees in pictures: the places of a body's or of hands' parts by name, metres, Y up. Its files are in a folder: of the npm
// packages `@mediapipe/pose` and `@mediapipe/hands`, which contain their models, or of `@mediapipe/tasks-vision` with a model beside them.

/** Landmarks whose middle is the joint; those of docs/guide/devices.md. */
const PARTS = {
  hips: [23, 24], neck: [11, 12], head: [7, 8],
  left_arm: [11], left_forearm: [13], left_hand: [15],
  right_arm: [12], right_forearm: [14], right_hand: [16],
  left_thigh: [23], left_shin: [25], left_foot: [27],
  right_thigh: [24], right_shin: [26], right_foot: [28],
};
/** A hand's 21: the wrist, then each finger from base to tip. */
const HAND = ["hand", ...["thumb", "index", "middle", "ring", "little"].flatMap((finger) => ["1", "2", "3", "tip"].map((at) => `${finger}_${at}`))];

/** Lines between landmarks, for drawing. */
const BODY_LINES = [
  [11, 12], [11, 13], [13, 15], [12, 14], [14, 16], [11, 23], [12, 24], [23, 24], [23, 25], [25, 27], [24, 26], [26, 28],
];
const HAND_LINES = [0, 1, 2, 3, 4].flatMap((finger) => [0, 1, 2, 3].map((at) => [at === 0 ? 0 : 4 * finger + at, 4 * finger + at + 1]));

/** What can be tracked: the npm package's script and class, the options of both ways, the newer way's class and models. */
const BODY = {
  script: "pose.js", global: "Pose", options: { modelComplexity: 1, smoothLandmarks: true },
  task: "PoseLandmarker", limit: { numPoses: 1 }, models: ["pose_landmarker_full.task", "pose_landmarker_heavy.task", "pose_landmarker_lite.task"],
  read: ({ poseLandmarks, poseWorldLandmarks }) => ({ pictures: [poseLandmarks], worlds: [poseWorldLandmarks], sides: [] }),
  lines: BODY_LINES, positions: ({ worlds, pictures }) => partsOf(worlds[0], pictures[0]),
};
const hands = (count) => ({
  script: "hands.js", global: "Hands", options: { modelComplexity: 1, maxNumHands: count },
  task: "HandLandmarker", limit: { numHands: count }, models: ["hand_landmarker.task"],
  read: ({ multiHandLandmarks, multiHandWorldLandmarks, multiHandedness }) => ({
    pictures: multiHandLandmarks ?? [], worlds: multiHandWorldLandmarks ?? [],
    // This package names sides as in a mirror, and pictures come unmirrored.
    sides: (multiHandedness ?? []).map(({ label }) => (label === "Left" ? "right" : "left")),
  }),
  lines: HAND_LINES, positions: handsOf,
});
const TRACKED = { body: BODY, hand: hands(1), hands: hands(2) };

/**
 * Places of the parts that the world landmarks of a body show: theirs have Y down and Z away from the camera. MediaPipe guesses what is
 * outside of the `picture`, often as visible: hips and legs of somebody at a desk. Guesses are left out.
 */
export function partsOf(world, picture) {
  const positions = {};
  const isInside = (number) => !picture || [picture[number].x, picture[number].y].every((at) => at >= 0 && at <= 1);
  for (const [part, numbers] of Object.entries(PARTS)) {
    const marks = numbers.map((number) => world[number]);
    if (marks.some((mark) => !mark || (mark.visibility ?? 1) <= 0.5) || !numbers.every(isInside)) continue;
    const middle = (axis) => marks.reduce((sum, mark) => sum + mark[axis], 0) / marks.length;
    positions[part] = [middle("x"), -middle("y"), -middle("z")];
  }
  return positions;
}

/**
 * Places of the parts of hands. World landmarks have their origin in each hand; where it is follows from the picture, which shows the hand
 * `scale` times as large (weak perspective), but for the distance from the camera, which stays unknown. `aspect` is width by height; `sides`
 * are `left` or `right`.
 */
export function handsOf({ pictures, worlds, sides }, aspect) {
  const positions = {};
  worlds.forEach((world, at) => {
    const picture = pictures[at].map(({ x, y }) => ({ x: x * aspect, y }));
    const mean = (marks, axis) => marks.reduce((sum, mark) => sum + mark[axis], 0) / marks.length;
    const spread = (marks) => Math.sqrt(["x", "y"].reduce((sum, axis) => {
      const middle = mean(marks, axis);
      return sum + marks.reduce((squares, mark) => squares + (mark[axis] - middle) ** 2, 0);
    }, 0));
    const scale = spread(picture) > 0 ? spread(world) / spread(picture) : 0;
    const aside = (mean(picture, "x") - aspect / 2) * scale - mean(world, "x");
    const down = (mean(picture, "y") - 0.5) * scale - mean(world, "y");
    // Of two hands of one side, one is taken for the other's.
    const isTaken = at > 0 && sides[at] === sides[0];
    const side = (sides[at] === "right") !== isTaken ? "right" : "left";
    HAND.forEach((part, number) => {
      const { x, y, z } = world[number];
      positions[`${side}_${part}`] = [x + aside, -(y + down), -z];
    });
  });
  return positions;
}

/**
 * A tracker of `what` (`body`, `hand`, `hands`): `track(video)` gives `positions`, and `pictures` and `lines` for drawing, or null where
 * nobody is seen; `close()` ends it.
 */
export async function tracker(folder, what) {
  const tracked = TRACKED[what];
  if (!tracked) throw new Error(`MediaPipe tracks ${Object.keys(TRACKED).join(", ")}, and not ${what}.`);
  const { see, close } = (await bySolution(folder, tracked)) ?? (await byTask(folder, tracked));
  const track = async (video) => {
    const seen = await see(video);
    if (!seen?.worlds[0]) return null;
    const positions = tracked.positions(seen, video.videoWidth / video.videoHeight);
    return { positions, pictures: seen.pictures, lines: tracked.lines };
  };
  return { track, close };
}

/** By the npm package of its own; null if the folder does not have it. */
async function bySolution(folder, { script, global, options, read }) {
  if (!globalThis[global] && !(await loaded(`${folder}/${script}`))) return null;
  const solution = new globalThis[global]({ locateFile: (file) => `${folder}/${file}` });
  solution.setOptions(drawsBySoftware() ? { ...options, useCpuInference: true } : options);
  let seen = null;
  solution.onResults((results) => (seen = read(results)));
  const see = async (image) => {
    seen = null;
    await solution.send({ image });
    return seen;
  };
  return { see, close: () => solution.close() };
}

const loaded = (address) => new Promise((done) => {
  const script = Object.assign(document.createElement("script"), { src: address, crossOrigin: "anonymous" });
  script.onload = () => done(true);
  script.onerror = () => done(false);
  document.head.append(script);
});

/** By `@mediapipe/tasks-vision` and the first of the models that is there. */
async function byTask(folder, { script, task, limit, models }) {
  const base = new URL(`${folder}/`, document.baseURI);
  const vision = await import(new URL("vision_bundle.mjs", base)).catch(() => {
    throw new Error(`MediaPipe is not in ${folder}: there is neither ${script} nor vision_bundle.mjs.`);
  });
  const files = await vision.FilesetResolver.forVisionTasks(new URL("wasm", base).href);
  const delegate = drawsBySoftware() ? "CPU" : "GPU";
  for (const model of models) {
    const answer = await fetch(new URL(model, base));
    if (!answer.ok) continue;
    const modelAssetBuffer = new Uint8Array(await answer.arrayBuffer());
    const made = await vision[task].createFromOptions(files, { baseOptions: { modelAssetBuffer, delegate }, runningMode: "VIDEO", ...limit });
    const see = async (video) => {
      const { landmarks, worldLandmarks, handedness } = made.detectForVideo(video, performance.now());
      return { pictures: landmarks, worlds: worldLandmarks, sides: (handedness ?? []).map(([first]) => first?.categoryName.toLowerCase()) };
    };
    return { see, close: async () => made.close() };
  }
  throw new Error(`MediaPipe's model is not in ${folder}: there is no ${models.join(", no ")}.`);
}

/** True where the processor stands in for a graphics card: MediaPipe is many times as fast there without shaders. */
function drawsBySoftware() {
  const gl = document.createElement("canvas").getContext("webgl2");
  const info = gl?.getExtension("WEBGL_debug_renderer_info");
  return !gl || /swiftshader|llvmpipe|software|basic render/i.test(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
}
