// The npm package in Node against native morec: an index gives the same detections to the bit. Training gives the same motions, with scores
// that agree to SCORE: its products of matrices are fused where the processor can. `crates/morec-wasm/test` makes both sides and runs this.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { basename, join } from "node:path";
import { performance } from "node:perf_hooks";
import { test } from "node:test";
import { pathToFileURL } from "node:url";

const [packageFolder, caseFolder] = [process.env.MOREC_PACKAGE, process.env.MOREC_CASES];
const { Clip, Index, read, roles, train, version } = await import(pathToFileURL(join(packageFolder, "morec.js")));
const { trainInWorker } = await import(pathToFileURL(join(packageFolder, "worker.js")));
const cases = JSON.parse(readFileSync(join(caseFolder, "cases.json"), "utf8"));

const SCORE = 1e-6;

const open = (path) => read(readFileSync(path), basename(path));
const indexFile = (name) => readFileSync(join(caseFolder, `${name}.index`));

/** Fails unless both are the same motions with nearly the same scores. */
function assertAlike(found, expected, path) {
  const bare = ({ class: name, start_secs, stop_secs, reported_secs }) => ({ name, start_secs, stop_secs, reported_secs });
  assert.deepEqual(found.map(bare), expected.map(bare), path);
  const unlike = found.map(({ score }, at) => Math.abs(score - expected[at].score));
  assert.ok(Math.max(0, ...unlike) < SCORE, `${path}: scores differ by ${Math.max(...unlike)}`);
}

/** Everything a recogniser of `clip`'s poses says, and microseconds a push. */
function pushed(index, clip, options) {
  const recognizer = index.recognizer(roles(), options);
  const [times, positions] = [clip.times(), clip.positions()];
  const width = positions.length / times.length;
  const frames = Array.from(times, (_, frame) => positions.subarray(frame * width, (frame + 1) * width));
  const events = [];
  const begun = performance.now();
  for (let frame = 0; frame < times.length; frame++) {
    const settled = recognizer.push(times[frame], frames[frame]);
    if (settled.length > 0) events.push(...settled);
  }
  const us = (1000 * (performance.now() - begun)) / times.length;
  events.push(...recognizer.finish());
  recognizer.free();
  return { events, us };
}

const ends = (events) =>
  events
    .filter((event) => event.phase === "end")
    .map(({ class: name, start_secs, stop_secs, score, reported_secs }) => ({
      class: name, start_secs, stop_secs, score, reported_secs,
    }));

for (const { name, labels, learn, recognise, detections, push_us } of cases) {
  test(`${name}: an index file of native morec finds the same, whole clips and pose by pose`, (t) => {
    const index = Index.fromBytes(indexFile(name));
    assert.deepEqual(Buffer.from(index.toBytes()), indexFile(name));
    let found = 0;
    let slowest = 0;
    recognise.forEach((path, at) => {
      const clip = open(path);
      assert.deepEqual(index.recognize(clip), detections[at], path);
      const live = pushed(index, clip);
      assert.deepEqual(ends(live.events), index.recognize(clip), path);
      found += detections[at].length;
      slowest = Math.max(slowest, live.us);
    });
    assert.ok(found > 0);
    t.diagnostic(`${found} detections; ${slowest.toFixed(1)} µs a push, native ${push_us.toFixed(1)}`);
  });

  test(`${name}: training gives an index that finds what the native one finds`, (t) => {
    const stages = new Set();
    const begun = performance.now();
    const clips = learn.map(open);
    const trained = train(clips, labels, { progress: (stage) => void stages.add(stage) });
    t.diagnostic(`${((performance.now() - begun) / 1000).toFixed(1)} s`);
    assert.ok(stages.size > 0);
    recognise.forEach((path, at) => assertAlike(trained.recognize(open(path)), detections[at], path));
  });
}

test("tentative events name a motion before its end, and no push allocates an array for nothing", () => {
  const [{ name, recognise }] = cases;
  const index = Index.fromBytes(indexFile(name));
  const { events } = pushed(index, open(recognise[0]), { tentative: true });
  const first = events.find((event) => event.phase === "end");
  const start = events.find((event) => event.phase === "start" && event.motion === first.motion);
  assert.ok(start && start.reported_secs < first.reported_secs);
  assert.ok(pushed(index, open(recognise[0])).events.every(({ phase }) => phase === "end"));
  const recognizer = index.recognizer(roles());
  const nobody = new Float32Array(3 * roles().length).fill(NaN);
  assert.equal(recognizer.push(0, nobody), recognizer.push(0.03, nobody));
});

test("a stream that shows nobody is diagnosed in words", () => {
  const recognizer = Index.fromBytes(indexFile(cases[0].name)).recognizer(roles());
  const nobody = new Float32Array(3 * roles().length).fill(NaN);
  for (let frame = 0; frame < 90; frame++) recognizer.push(frame / 30, nobody);
  const [worst] = recognizer.diagnosis();
  assert.match(worst, /\w+ \w+/);
});

test("what is wrong is said, and the recogniser goes on", () => {
  const index = Index.fromBytes(indexFile(cases[0].name));
  assert.throws(() => Index.fromBytes(new Uint8Array(10)), /\w/);
  assert.throws(() => index.recognizer(["a", "b"]), /a known set of points/);
  assert.throws(() => index.recognizer(roles(), { upp: "y" }), /upp: unknown field `upp`/);
  assert.throws(() => index.recognizer(roles(), { performer: "me" }), /performer: unknown variant `me`/);
  assert.throws(() => index.recognizer(roles(), { up: "w" }), /up: expected x, y, z/);
  assert.throws(() => read(new TextEncoder().encode("no clip"), "a.bvh"), /a\.bvh/);
  assert.throws(() => train([], [{ clip: "a", class: "b", start_secs: 1 }]), /row 1/);
  const recognizer = index.recognizer(roles());
  assert.throws(() => recognizer.push(0, new Float32Array(3)), /expected \d+ numbers.*found 3/);
  assert.throws(() => recognizer.push(0, undefined), /expected \d+ numbers/);
  assert.deepEqual(recognizer.push(0, new Float32Array(3 * roles().length)), []);
});

test("progress that returns false, or throws, cancels", () => {
  const [{ labels, learn }] = cases;
  const clips = learn.map(open);
  assert.throws(() => train(clips, labels, { progress: () => false }), /cancel/);
  assert.throws(() => train(clips, labels, { progress: () => { throw new Error("no"); } }), /cancel/);
});

test("a worker trains, with progress, and is stopped by a signal", async () => {
  const [{ name, labels, learn }] = cases;
  const files = learn.map((path) => ({ bytes: readFileSync(path), name: basename(path) }));
  let steps = 0;
  const { bytes } = await trainInWorker(files, labels, { progress: () => steps++ });
  assert.ok(steps > 0);
  assert.deepEqual(Index.fromBytes(bytes).classes, Index.fromBytes(indexFile(name)).classes);
  const stop = new AbortController();
  const stopped = trainInWorker(files, labels, { signal: stop.signal, progress: () => stop.abort() });
  await assert.rejects(stopped, { name: "AbortError" });
  await assert.rejects(trainInWorker(files, [{ clip: "a" }]), /labels: missing field `class`/);
});

test("points of a landmark library make a clip and a stream", () => {
  const clip = open(cases[0].recognise[0]);
  const positions = Float32Array.from(clip.positions());
  const again = Clip.fromPositions("again", roles(), clip.rate_hz, positions, clip.frames);
  assert.equal(again.frames, clip.frames);
  assert.ok(Index.fromBytes(indexFile(cases[0].name)).recognize(again).length > 0);
  assert.match(version(), /^\d+\.\d+\.\d+/);
});
