// The page: buttons, pictures and lists around `teaching.js`.
import * as morec from "./vendor/morec/morec.js";
import { trainInWorker } from "./vendor/morec/worker.js";
import { keep, place } from "./kept.js";
import { outlets } from "./outlets.js";
import { camera, drawLandmarks, film, inTurn, inWords, recorded } from "./sources.js";
import { Teaching } from "./teaching.js";
import { Stage } from "./vendor/stage.js";

const MEDIAPIPE = "./vendor/mediapipe";
const COUNTDOWN_SECS = 3;

const at = (id) => document.getElementById(id);
const teaching = new Teaching(morec, trainInWorker);
const drawing = at("drawing").getContext("2d");
const turns = inTurn();
const stage = new Stage();
/** Sources that run or wait for their turn. */
let running = 0;
let busy = false;
let send = () => {};

const say = (text) => (at("state").textContent = text);
/** Beside the buttons of sources. */
const saySource = (text) => (at("source-state").textContent = text);
const wait = (secs) => new Promise((done) => setTimeout(done, 1000 * secs));

/** Runs `job`; what goes wrong is said, in words. */
const handled = (job, said = say) => async (...given) => {
  try {
    await job(...given);
  } catch (error) {
    said(inWords(error));
  } finally {
    show();
  }
};
const on = (id, type, job, said) => at(id).addEventListener(type, handled(job, said));

async function run(source) {
  running++;
  saySource("");
  stage.warn([]);
  show();
  try {
    await turns.run(async (signal) => {
      try {
        await source((secs, positions, seen) => {
          const first = !teaching.hasPoses;
          stage.pass(secs);
          teaching.pose(secs, positions);
          if (first) show();
          draw(positions, seen);
        }, signal);
      } finally {
        teaching.finish();
      }
    });
  } finally {
    running--;
  }
}

/** The skeleton, over the picture or, without one, seen from the front. */
function draw(positions, seen) {
  const canvas = drawing.canvas;
  [canvas.width, canvas.height] = [canvas.clientWidth, canvas.clientHeight];
  drawing.fillStyle = drawing.strokeStyle = getComputedStyle(canvas).getPropertyValue("--accent");
  drawing.lineWidth = 4;
  if (seen) {
    drawLandmarks(drawing, at("video"), seen);
    return;
  }
  const body = positions.hips ?? positions.neck;
  const scale = canvas.height / (body ? 2.4 : 0.6);
  const middle = body ?? positions.right_hand ?? positions.left_hand ?? [0, 0, 0];
  for (const place of Object.values(positions)) {
    if (!place) continue;
    drawing.beginPath();
    drawing.arc(canvas.width / 2 + (place[0] - middle[0]) * scale, canvas.height / 2 - (place[1] - middle[1]) * scale, 5, 0, 7);
    drawing.fill();
  }
}

/** What can be done, and what there is. */
function show() {
  at("stop").disabled = !running;
  at("record").disabled = !running || busy;
  at("cut").disabled = busy || !teaching.hasPoses;
  at("train").disabled = busy || teaching.samples.length === 0;
  at("save-samples").disabled = teaching.samples.length === 0;
  at("undo").disabled = !teaching.canUndo;
  at("save-index").disabled = !teaching.index;
  at("known").textContent = teaching.index
    ? `Recognises ${teaching.index.classes.join(", ")}.`
    : "Train, or open an index made with the studio or the command.";
}

function listClasses() {
  const rows = [...teaching.classes()].map(([name, samples]) => {
    const row = document.createElement("li");
    row.append(`${name}: `);
    samples.forEach((sample, number) => row.append(button(`Delete sample ${number + 1} of ${name}`, `✕ ${number + 1}`, () => teaching.remove(sample)), " "));
    row.append(button(`Rename ${name}`, "Rename", () => {
      const to = prompt(`New name of ${name}`, name);
      if (to !== null) teaching.rename(name, to);
    }));
    return row;
  });
  at("classes").replaceChildren(...rows);
}

function button(label, text, job) {
  const made = document.createElement("button");
  made.setAttribute("aria-label", label);
  made.textContent = text;
  made.addEventListener("click", handled(job));
  return made;
}

/** The performer's samples: a countdown, then the motion. */
async function record() {
  const [name, secs] = [at("name").value, Number(at("secs").value)];
  busy = true;
  show();
  try {
    for (let left = COUNTDOWN_SECS; left > 0; left--) {
      say(`${name} in ${left} …`);
      stage.say(String(left));
      await wait(1);
    }
    say(`Perform ${name} now.`);
    stage.say(name);
    teaching.record();
    await wait(secs);
    teaching.keep(name);
    say(`Kept: ${teaching.classes().get(name.trim()).length} of ${name}. Two samples of each motion are enough.`);
  } finally {
    busy = false;
    stage.say("");
  }
}

async function train() {
  busy = true;
  show();
  try {
    const begun = performance.now();
    const progress = (stage, done, total) => say(`Training: ${stage} ${done}/${total}`);
    const notes = await teaching.train({ progress });
    say([`Trained in ${((performance.now() - begun) / 1000).toFixed(1)} s.`, ...notes].join(" "));
  } finally {
    busy = false;
  }
}

function download(bytes, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([bytes]));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

/** Opens the file that is chosen in `id`, and again if the same one is chosen again. */
const onFile = (id, job) => on(id, "change", async () => {
  const [file] = at(id).files;
  at(id).value = "";
  if (file) await job(file);
}, id === "source-file" ? saySource : say);

on("camera", "click", () => run(camera(at("video"), MEDIAPIPE, at("track").value)), saySource);
on("track", "change", () => turns.stop());
on("stop", "click", () => turns.stop());
onFile("source-file", async (file) => run(file.type.startsWith("video/") ? film(at("video"), MEDIAPIPE, at("track").value, file) : recorded(await file.text())));
on("sample", "submit", record);
at("sample").addEventListener("submit", (event) => event.preventDefault());
on("cut", "click", () => {
  teaching.cut(at("name").value, Number(at("secs").value));
  say(`Kept the last ${at("secs").value} seconds.`);
});
on("train", "click", train);
on("undo", "click", () => teaching.undo());
on("save-samples", "click", () => download(teaching.saved(), "samples.json"));
onFile("samples-file", async (file) => teaching.restore(await file.text()));
on("save-index", "click", () => download(teaching.index.toBytes(), "motions.index"));
onFile("index-file", async (file) => teaching.load(new Uint8Array(await file.arrayBuffer())));

let shownIndex = null;
teaching.addEventListener("change", () => {
  if (teaching.index !== shownIndex) {
    shownIndex = teaching.index;
    stage.begin(shownIndex?.classes ?? []);
  }
  listClasses();
  show();
});
teaching.addEventListener("diagnosis", ({ detail }) => stage.warn(detail));
teaching.addEventListener("motion", ({ detail }) => {
  send(detail);
  stage.take(detail);
  if (detail.phase !== "end") return;
  const row = document.createElement("li");
  row.className = "now";
  const times = detail.repetitions ? ` × ${detail.repetitions}` : "";
  row.textContent = `${detail.class}${times}, score ${detail.score.toFixed(2)}, ${detail.start_secs.toFixed(1)} to ${detail.stop_secs.toFixed(1)} s`;
  at("events").firstElementChild?.classList.remove("now");
  at("events").prepend(row);
});
try {
  send = outlets(new URLSearchParams(location.search));
} catch (error) {
  say(`socket: ${error.message}`);
}
show();
try {
  const kept = await place();
  if (kept) await keep(teaching, kept, (error) => say(inWords(error)));
} catch (error) {
  // A browser that keeps nothing, as in a private window: the page works all the same.
  console.warn(error);
}
