// What the page shows and keeps beside teaching, in Node alone: bars, what survives a reload, errors of browsers in words.
import assert from "node:assert/strict";
import { test } from "node:test";

import { Nearness } from "../../crates/morec-live/src/webcam/nearness.js";
import { inWords } from "../../crates/morec-live/src/webcam/words.js";
import { keep } from "../kept.js";
import { Teaching } from "../teaching.js";

const event = (name, phase, progress, motion = 1) => ({ class: name, phase, progress, motion });

test("bars say how far a motion has come, whether it was nearly one, and what was recognised", () => {
  const near = new Nearness();
  near.begin(["wave", "bow"]);
  near.pass(1);
  near.take(event("wave", "start", 0.3));
  assert.deepEqual(near.rows, [{ name: "wave", share: 0.3, word: "" }, { name: "bow", share: 0, word: "" }]);
  near.take(event("wave", "update", 0.7));
  near.take(event("wave", "cancel", 0.7));
  assert.deepEqual(near.rows[0], { name: "wave", share: 0.7, word: "nearly" });
  assert.equal(near.recognised, "");
  near.pass(3.1);
  assert.deepEqual(near.rows[0], { name: "wave", share: 0, word: "" });
  near.take(event("bow", "end", 1, 2));
  assert.equal(near.recognised, "bow");
  near.pass(4);
  assert.equal(near.recognised, "bow");
  near.pass(5.2);
  assert.equal(near.recognised, "");
});

test("a motion that turns out to be another class is nearly none of the first", () => {
  const near = new Nearness();
  near.begin(["wave", "bow"]);
  near.take(event("wave", "start", 0.8));
  near.take(event("bow", "update", 0.9));
  assert.deepEqual(near.rows, [{ name: "wave", share: 0, word: "" }, { name: "bow", share: 0.9, word: "" }]);
  // What is far from one is not called nearly, and an unknown class breaks nothing.
  near.take(event("bow", "start", 0.2, 3));
  near.take(event("bow", "cancel", 0.2, 3));
  near.take(event("hop", "end", 1, 4));
  assert.deepEqual(near.rows.map(({ word }) => word), ["", ""]);
});

/** The package's parts that teaching without poses needs. */
const morec = {
  roles: () => ["hips"],
  Index: { fromBytes: (bytes) => ({ bytes, classes: ["wave"], toBytes: () => bytes, free() {} }) },
};

test("what was taught is there when the page is opened again", async () => {
  let kept;
  const place = { put: async (value) => (kept = structuredClone(value)), get: async () => kept };
  const teaching = new Teaching(morec, async () => ({ bytes: new Uint8Array([7]), notes: [] }));
  await keep(teaching, place);
  const poses = Array.from({ length: 60 }, (_, at) => ({ t: at / 30, positions: { hips: [0, 1, at] } }));
  teaching.add("wave", poses);
  teaching.add("wave", poses);
  teaching.rename("wave", "greet");
  await teaching.train();
  await new Promise((done) => setTimeout(done));
  const again = new Teaching(morec, null);
  await keep(again, place);
  assert.deepEqual([...again.classes()].map(([name, samples]) => [name, samples.length]), [["greet", 2]]);
  assert.deepEqual(again.samples[0].poses, poses);
  assert.deepEqual([...again.index.bytes], [7]);
  // There is nothing to undo that was not done here.
  assert.equal(again.canUndo, false);
  // A browser that refuses is said and stops nothing.
  const errors = [];
  const refusing = new Teaching(morec, null);
  await keep(refusing, { get: async () => undefined, put: async () => { throw new Error("full"); } }, (error) => errors.push(error.message));
  refusing.add("bow", poses);
  await new Promise((done) => setTimeout(done));
  assert.deepEqual([errors, refusing.samples.length], [["full"], 1]);
});

test("errors of browsers are said in words, with what to do", () => {
  const named = (name) => Object.assign(new Error("x"), { name });
  assert.match(inWords(named("NotAllowedError")), /allow.*camera/i);
  assert.match(inWords(named("NotFoundError")), /no camera/i);
  assert.match(inWords(named("NotReadableError")), /another program/);
  assert.match(inWords(named("NotSupportedError")), /film/);
  assert.match(inWords(named("SyntaxError")), /not what was expected/);
  assert.equal(inWords(new Error("The motion needs a name.")), "The motion needs a name.");
  assert.equal(inWords("odd"), "odd");
});
