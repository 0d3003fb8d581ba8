// The page of `--listen webcam`: poses go to morec as lines of JSON; countdowns, motions and problems come back.
import { camera, drawLandmarks, inTurn } from "./camera.js";
import { Stage } from "./stage.js";
import { inWords } from "./words.js";

const at = (id) => document.getElementById(id);
const say = (text) => (at("state").textContent = text);
const drawing = at("drawing").getContext("2d");
const stage = new Stage();
let socket = null;
let tried = -Infinity;

/** What morec has to say to somebody before the camera. */
const TOLD = {
  classes: ({ names }) => stage.begin(names),
  say: ({ text }) => stage.say(text),
  problems: ({ sentences }) => stage.warn(sentences),
  motion: (event) => stage.take(event),
};

/** The connection to morec; if it ended, tried anew once a second. */
function connection() {
  if (!(socket?.readyState <= WebSocket.OPEN) && performance.now() - tried > 1000) {
    tried = performance.now();
    socket = new WebSocket(`ws://${location.host}/poses`);
    socket.onclose = () => {
      say("morec has ended, or does not answer.");
      stage.say("");
      stage.warn([]);
    };
    // What is wrong with the camera stays.
    socket.onopen = () => at("again").hidden && say("morec listens.");
    socket.onmessage = ({ data }) => {
      const told = JSON.parse(data);
      TOLD[told.type]?.(told);
    };
  }
  return socket;
}

function take(secs, positions, seen) {
  stage.pass(secs);
  const { canvas } = drawing;
  [canvas.width, canvas.height] = [canvas.clientWidth, canvas.clientHeight];
  drawing.strokeStyle = getComputedStyle(canvas).getPropertyValue("--accent");
  drawing.lineWidth = 4;
  drawLandmarks(drawing, at("video"), seen);
  const { readyState } = connection();
  if (readyState === WebSocket.OPEN && Object.keys(positions).length > 0) socket.send(JSON.stringify({ t: secs, positions }));
}

const turns = inTurn();

/** Tracks what the list says. */
const run = () => turns.run((signal) => {
  at("again").hidden = true;
  say(socket?.readyState === WebSocket.OPEN ? "morec listens." : "Starting the camera …");
  return camera(at("video"), "mediapipe", at("track").value)(take, signal);
}).catch((error) => {
  say(inWords(error));
  at("again").hidden = false;
});

at("track").value = document.body.dataset.track;
at("track").addEventListener("change", run);
at("again").addEventListener("click", run);
connection();
run();
