// `morec live --listen webcam` in Chromium: its page, with a stand-in for MediaPipe that shows recorded landmarks, and events on the command's
// output. Needs what `web/test` gets, and the command.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { createInterface } from "node:readline";
import { test } from "node:test";
import { pathToFileURL } from "node:url";

const { MOREC_PACKAGE, MOREC_CASES, MOREC_TOOLS, MOREC_CHROMIUM, MOREC_COMMAND } = process.env;
const skip = MOREC_CHROMIUM && MOREC_COMMAND ? false : "there is no Chromium, or the command is not built";
const morec = await import(pathToFileURL(join(MOREC_PACKAGE, "morec.js")));
const { name, recognise, detections } = JSON.parse(readFileSync(join(MOREC_CASES, "cases.json"), "utf8"))[0];

/** MediaPipe's number of each landmark that is a joint by itself. */
const NUMBERS = {
  left_arm: 11, left_forearm: 13, left_hand: 15, right_arm: 12, right_forearm: 14, right_hand: 16,
  left_thigh: 23, left_shin: 25, left_foot: 27, right_thigh: 24, right_shin: 26, right_foot: 28,
};

/** World landmarks of each frame: from the hips, Y down, Z away from the camera. */
function landmarks(clip) {
  const [positions, roles] = [clip.positions(), morec.roles()];
  const place = (frame, role) => positions.subarray(3 * (frame * roles.length + roles.indexOf(role))).slice(0, 3);
  return Array.from({ length: clip.frames }, (_, frame) => {
    const [left, right] = [place(frame, "left_thigh"), place(frame, "right_thigh")];
    const mark = ([x, y, z], aside = 0) => ({
      x: x - (left[0] + right[0]) / 2 + aside, y: (left[1] + right[1]) / 2 - y, z: (left[2] + right[2]) / 2 - z, visibility: 1,
    });
    const marks = new Array(33).fill(null);
    for (const [role, number] of Object.entries(NUMBERS)) marks[number] = mark(place(frame, role));
    const head = place(frame, "head");
    [marks[7], marks[8]] = [mark(head, 0.08), mark(head, -0.08)];
    return marks;
  });
}

/** What takes the place of MediaPipe: the landmarks of the moment, whatever the picture. */
const standIn = (rows, rate_hz) => `
  const rows = ${JSON.stringify(rows)};
  let begun = null;
  globalThis.Pose = class {
    setOptions() {}
    onResults(take) { this.take = take; }
    async send() {
      begun ??= performance.now();
      const row = rows[Math.floor((performance.now() - begun) / 1000 * ${rate_hz})];
      if (row) this.take({ poseWorldLandmarks: row, poseLandmarks: row.map(() => ({ x: 0.5, y: 0.5 })) });
      else document.title = "done";
    }
    async close() {}
  };`;

test("the camera's page sends what MediaPipe sees, and the command recognises it", { skip, timeout: 120_000 }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "morec-webcam-"));
  const clip = morec.read(readFileSync(recognise[0]), basename(recognise[0]));
  // As it goes at its own pace, half of the clip will do.
  const secs = 45;
  writeFileSync(join(folder, "pose.js"), standIn(landmarks(clip).slice(0, secs * clip.rate_hz), clip.rate_hz));
  const live = spawn(MOREC_COMMAND, [
    "live", join(MOREC_CASES, `${name}.index`), "--listen", "webcam://127.0.0.1:0", "--mediapipe", folder, "--emit", "json:-",
  ]);
  let browser;
  try {
    const events = [];
    createInterface({ input: live.stdout }).on("line", (line) => events.push(JSON.parse(line)));
    const page = await new Promise((found, failed) => {
      const said = [];
      createInterface({ input: live.stderr }).on("line", (line) => {
        said.push(line);
        if (line.includes("the page of the webcam is ")) found(line.split("the page of the webcam is ")[1]);
      });
      live.once("exit", () => failed(new Error(said.join("; "))));
    });
    const { chromium } = createRequire(join(MOREC_TOOLS, "tools.js"))("playwright-core");
    const camera = ["--use-fake-ui-for-media-stream", "--use-fake-device-for-media-stream"];
    browser = await chromium.launch({ executablePath: MOREC_CHROMIUM, args: ["--no-sandbox", ...camera] });
    const tab = await browser.newPage();
    const errors = [];
    tab.on("pageerror", (error) => errors.push(String(error)));
    await tab.goto(page);
    await tab.getByText("morec listens.").waitFor();
    await tab.evaluate(() => {
      const large = document.getElementById("large");
      globalThis.large = new Set();
      new MutationObserver(() => globalThis.large.add(large.textContent)).observe(large, { childList: true });
    });
    await tab.waitForFunction(() => document.title === "done", null, { timeout: 90_000 });
    assert.deepEqual(errors, []);
    // Somebody before the camera sees a bar for each class, and large what is recognised.
    const classes = new Set(detections[0].map((row) => row.class));
    const bars = await tab.locator("#bars meter").evaluateAll((meters) => meters.map((meter) => meter.getAttribute("aria-label")));
    assert.ok([...classes].every((motion) => bars.includes(motion)), bars.join("; "));
    const large = await tab.evaluate(() => [...globalThis.large].filter(Boolean));
    assert.ok(large.length > 1 && large.every((motion) => bars.includes(motion)), large.join("; "));
    live.kill("SIGINT");
    await new Promise((done) => live.once("close", done));
    const found = new Set(events.map((event) => event.class));
    const shown = detections[0].filter((row) => row.stop_secs < secs - 1);
    const expected = new Set(shown.map((row) => row.class));
    assert.ok(expected.size > 1);
    const missed = [...expected].filter((motion) => !found.has(motion));
    assert.ok(missed.length <= expected.size / 3, `found ${[...found]}, missed ${missed}`);
  } finally {
    await browser?.close();
    live.kill("SIGKILL");
    rmSync(folder, { recursive: true });
  }
});
