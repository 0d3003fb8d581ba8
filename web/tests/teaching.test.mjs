// The page's logic in Node, with recorded poses: teach, train, recognise, save, load. Needs what `crates/morec-wasm/test` makes.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { basename, join } from "node:path";
import { before, test } from "node:test";
import { pathToFileURL } from "node:url";

import { partsOf, recorded } from "../sources.js";
import { Teaching, linesOf } from "../teaching.js";

const [packageFolder, caseFolder] = [process.env.MOREC_PACKAGE, process.env.MOREC_CASES];
const morec = await import(pathToFileURL(join(packageFolder, "morec.js")));
const { trainInWorker } = await import(pathToFileURL(join(packageFolder, "worker.js")));
const { learn, recognise, labels } = JSON.parse(readFileSync(join(caseFolder, "cases.json"), "utf8"))[0];
const rows = labels.trim().split("\n").slice(1).map((line) => line.split("\t"));
const TAUGHT = ["wave", "bow"];
const UPPER = ["hips", "neck", "head", "left_arm", "left_forearm", "left_hand", "right_arm", "right_forearm", "right_hand"];

/** Poses of a clip: only `parts`, if they are given. */
function posesOf(path, parts) {
  const clip = morec.read(readFileSync(path), basename(path));
  const [times, positions, roles] = [clip.times(), clip.positions(), morec.roles()];
  return Array.from(times, (t, frame) => {
    const places = {};
    roles.forEach((role, at) => {
      const start = 3 * (frame * roles.length + at);
      const place = Array.from(positions.subarray(start, start + 3));
      if (place.every(Number.isFinite) && (!parts || parts.includes(role))) places[role] = place;
    });
    return { t, positions: places };
  });
}

/** A performer who taught `TAUGHT` twice. */
function taught(parts) {
  const teaching = new Teaching(morec, trainInWorker);
  const poses = posesOf(learn[0], parts);
  const name = basename(learn[0], ".bvh");
  for (const [clip, motion, start, stop] of rows) {
    if (clip !== name || !TAUGHT.includes(motion)) continue;
    // Half a second before and after, as somebody before a camera leaves it.
    teaching.record();
    for (const pose of poses) if (pose.t > start - 0.5 && pose.t < Number(stop) + 0.5) teaching.pose(pose.t, pose.positions);
    teaching.keep(motion);
  }
  return teaching;
}

async function found(teaching, path, parts) {
  const events = [];
  const listen = ({ detail }) => detail.phase === "end" && events.push(detail);
  teaching.addEventListener("motion", listen);
  const poses = posesOf(path, parts);
  await recorded(linesOf(poses), { atOnce: true })((t, positions) => teaching.pose(t, positions), new AbortController().signal);
  teaching.finish();
  teaching.removeEventListener("motion", listen);
  return events.map(({ class: name, start_secs: start, stop_secs: stop, score }) => ({ name, start, stop, score }));
}

let whole;
before(async () => {
  whole = taught();
  await whole.train();
});

test("two samples of each motion are recognised in the same performer's stream", async () => {
  assert.deepEqual([...whole.classes()].map(([name, samples]) => [name, samples.length]), TAUGHT.map((name) => [name, 2]));
  const events = await found(whole, learn[0]);
  const own = rows.filter(([clip, motion]) => clip === basename(learn[0], ".bvh") && TAUGHT.includes(motion));
  for (const [, motion, start, stop] of own) {
    const middle = (Number(start) + Number(stop)) / 2;
    assert.ok(events.some((event) => event.name === motion && event.start < middle && middle < event.stop), `${motion} at ${start}`);
  }
});

test("the upper body alone is taught and recognised", async () => {
  const teaching = taught(UPPER);
  await teaching.train();
  const events = await found(teaching, learn[0], UPPER);
  assert.ok(events.filter(({ name }) => name === "wave").length >= 2, JSON.stringify(events));
});

test("index and samples are saved and opened, with the same events", async () => {
  const other = new Teaching(morec, trainInWorker);
  other.load(whole.index.toBytes());
  assert.deepEqual(await found(other, recognise[0]), await found(whole, recognise[0]));
  other.restore(whole.saved());
  assert.deepEqual(other.samples, whole.samples);
  assert.throws(() => other.restore("{}"), /no file of samples/);
});

test("samples are renamed, deleted, and brought back", () => {
  const teaching = new Teaching(morec, trainInWorker);
  const poses = [{ t: 0, positions: {} }, { t: 1, positions: {} }];
  teaching.add("wave", poses);
  teaching.rename("wave", "greet");
  teaching.remove(teaching.samples[0]);
  assert.equal(teaching.samples.length, 0);
  teaching.undo();
  assert.deepEqual(teaching.samples.map((sample) => sample.class), ["greet"]);
  teaching.undo();
  assert.deepEqual(teaching.samples.map((sample) => sample.class), ["wave"]);
  assert.throws(() => teaching.add(" ", poses), /needs a name/);
  assert.throws(() => teaching.add("wave", []), /Nobody was seen/);
});

test("MediaPipe's landmarks become parts of the body, without those that are hardly seen", () => {
  const world = Array.from({ length: 33 }, (_, at) => ({ x: at, y: 1, z: 2, visibility: at < 25 ? 0.9 : 0.1 }));
  const parts = partsOf(world);
  assert.deepEqual(parts.hips, [23.5, -1, -2]);
  assert.ok(parts.right_hand && !parts.left_foot);
});
