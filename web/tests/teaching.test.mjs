// The page's logic in Node, with recorded poses: teach, train, recognise, save, load. Needs what `crates/morec-wasm/test` makes.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { basename, join } from "node:path";
import { before, test } from "node:test";
import { pathToFileURL } from "node:url";

import { handsOf, partsOf, recorded } from "../sources.js";
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
  assert.throws(() => other.restore("{}"), /does not contain samples/);
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
  assert.throws(() => teaching.add("wave", []), /No person was tracked/);
});

test("MediaPipe's landmarks become parts of the body, without those that are hardly seen", () => {
  const world = Array.from({ length: 33 }, (_, at) => ({ x: at, y: 1, z: 2, visibility: at < 25 ? 0.9 : 0.1 }));
  const parts = partsOf(world);
  assert.deepEqual(parts.hips, [23.5, -1, -2]);
  assert.ok(parts.right_hand && !parts.left_foot);
});

const FINGERS = ["thumb", "index", "middle", "ring", "little"];
const HAND = ["hand", ...FINGERS.flatMap((finger) => ["1", "2", "3", "tip"].map((at) => `${finger}_${at}`))];

/** A hand's 21 points, metres: fingers up, bent by `bend` radians a joint, the whole turned by `turn` about the line of sight. */
function handPoints(bend, turn) {
  const points = [[0, 0, 0]];
  FINGERS.forEach((_, finger) => {
    let [x, y, z, angle] = [0.02 * (finger - 2), finger === 0 ? 0.03 : 0.09, 0, 0];
    for (let at = 0; at < 4; at++) {
      points.push([x, y, z]);
      angle += bend;
      [y, z] = [y + 0.03 * Math.cos(angle), z + 0.03 * Math.sin(angle)];
    }
  });
  return points.map(([x, y, z]) => [x * Math.cos(turn) - y * Math.sin(turn), x * Math.sin(turn) + y * Math.cos(turn), z]);
}

const bump = (t) => (t > 0 && t < 1.2 ? (1 - Math.cos((2 * Math.PI * t) / 1.2)) / 2 : 0);
/** Poses of `secs` seconds in which a fist is made from each of `fists` on, and the hand waves from each of `waves` on. */
function handPoses(secs, { fists = [], waves = [] }, side = "right") {
  return Array.from({ length: 30 * secs }, (_, frame) => {
    const t = frame / 30;
    const sum = (starts) => starts.reduce((total, start) => total + bump(t - start), 0);
    const points = handPoints(0.05 + 1.2 * sum(fists), 0.8 * sum(waves));
    const mirrored = side === "left" ? points.map(([x, y, z]) => [-x, y, z]) : points;
    return { t, positions: Object.fromEntries(HAND.map((part, at) => [`${side}_${part}`, mirrored[at]])) };
  });
}

test("one hand is taught, and recognised on either side", async () => {
  const teaching = new Teaching(morec, trainInWorker);
  for (const [name, what] of [["fist", "fists"], ["wave", "waves"]]) {
    for (let sample = 0; sample < 2; sample++) teaching.add(name, handPoses(3, { [what]: [0.9] }));
  }
  await teaching.train();
  for (const side of ["right", "left"]) {
    const events = [];
    teaching.addEventListener("motion", ({ detail }) => detail.phase === "end" && events.push(detail.class));
    for (const { t, positions } of handPoses(14, { fists: [3, 9], waves: [6] }, side)) teaching.pose(t, positions);
    teaching.finish();
    assert.deepEqual(events.slice(-3), ["fist", "wave", "fist"], side);
  }
});

test("a hand is placed where the picture shows it, and two hands are two", () => {
  const world = handPoints(0.3, 0.2).map(([x, y, z]) => ({ x, y: -y, z: -z }));
  // 0.3 m of the room are as high as the picture; the wrist is 0.1 m right of the middle and 0.05 m below.
  const picture = world.map(({ x, y }) => ({ x: 0.5 + (x + 0.1) / 0.3 / 1.5, y: 0.5 + (y + 0.05) / 0.3 }));
  const seen = handsOf({ pictures: [picture], worlds: [world], sides: ["right"] }, 1.5);
  const off = Math.hypot(...seen.right_hand.map((value, axis) => value - [0.1, -0.05, 0][axis]));
  assert.ok(off < 1e-9, `${seen.right_hand}`);
  assert.equal(Object.keys(seen).length, 21);
  const both = handsOf({ pictures: [picture, picture], worlds: [world, world], sides: ["left", "left"] }, 1.5);
  assert.equal(Object.keys(both).length, 42);
});

test("an index of bodies says what it is when a hand is shown", async () => {
  const teaching = new Teaching(morec, trainInWorker);
  teaching.load(whole.index.toBytes());
  const said = [];
  teaching.addEventListener("diagnosis", ({ detail }) => said.push(...detail));
  for (const { t, positions } of handPoses(4, {})) teaching.pose(t, positions);
  assert.match(said.join("\n"), /this index recognises a body, but the input shows a (right )?hand/);
});
