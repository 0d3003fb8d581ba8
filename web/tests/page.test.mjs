// The page in Chromium: recorded landmarks drive teach → train → recognise → save → load. Needs what `web/test` gets.
import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";

const { MOREC_PACKAGE, MOREC_CASES, MOREC_TOOLS, MOREC_CHROMIUM } = process.env;
const skip = MOREC_CHROMIUM ? false : "there is no Chromium here";
const morec = await import(pathToFileURL(join(MOREC_PACKAGE, "morec.js")));
const { learn, labels } = JSON.parse(readFileSync(join(MOREC_CASES, "cases.json"), "utf8"))[0];
const { serve } = await import(pathToFileURL(join(MOREC_PACKAGE, "serve.js")));

/** Stands in for `@mediapipe/tasks-vision`: what it was made with, and a hand whose points are all in one place. */
const VISION = `
  export const FilesetResolver = { forVisionTasks: async (folder) => folder };
  export const HandLandmarker = { createFromOptions: async (files, { baseOptions, runningMode, numHands }) => ({
    close() {},
    detectForVideo: () => ({
      landmarks: [new Array(21).fill({ x: 0.5, y: 0.5 })],
      worldLandmarks: [new Array(21).fill({ x: numHands, y: baseOptions.modelAssetBuffer.length, z: files.endsWith("/wasm") ? 1 : 0 })],
      handedness: [[{ categoryName: runningMode === "VIDEO" ? "Right" : "" }]],
    }),
  }) };`;

let server, browser, page, mediapipe;
const errors = [];

before(async () => {
  if (skip) return;
  // As `npx morec` serves it.
  mediapipe = mkdtempSync(join(tmpdir(), "morec-mediapipe-"));
  server = await serve({ port: 0, mediapipe: [mediapipe] });
  const { chromium } = createRequire(join(MOREC_TOOLS, "tools.js"))("playwright-core");
  browser = await chromium.launch({ executablePath: MOREC_CHROMIUM, args: ["--no-sandbox"] });
  page = await browser.newPage({ viewport: { width: 390, height: 844 } });
  page.on("pageerror", (error) => errors.push(String(error)));
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  await page.getByText("Train, or open an index").waitFor();
});

after(async () => {
  await browser?.close();
  server?.close();
  if (mediapipe) rmSync(mediapipe, { recursive: true });
});

/** Lines of JSON with two performances of each of two motions, in all and each by itself. */
function performance() {
  const name = basename(learn[0], ".bvh");
  const clip = morec.read(readFileSync(learn[0]), `${name}.bvh`);
  const [times, positions, roles] = [clip.times(), clip.positions(), morec.roles()];
  const [lines, parts] = [[], []];
  let now = 0;
  const rows = labels.trim().split("\n").map((line) => line.split("\t"));
  for (const [of, motion, start, stop] of rows) {
    if (of !== name || !["wave", "bow"].includes(motion)) continue;
    const from = Math.max(0, start - 0.8);
    const until = Number(stop) + 0.8;
    const first = lines.length;
    times.forEach((t, frame) => {
      if (t < from || t > until) return;
      const places = roles.map((role, at) => [role, Array.from(positions.subarray(3 * (frame * roles.length + at), 3 * (frame * roles.length + at + 1)))]);
      lines.push(JSON.stringify({ t: now + t - from, positions: Object.fromEntries(places.filter(([, place]) => place.every(Number.isFinite))) }));
    });
    now += until - from;
    parts.push({ motion, lines: lines.slice(first) });
  }
  return { lines, parts };
}

test("the page teaches, trains, recognises, saves and loads", { skip, timeout: 180_000 }, async () => {
  const { lines, parts } = performance();
  const play = async (poses) => {
    const buffer = Buffer.from(poses.join("\n"));
    await page.locator("#source-file").setInputFiles({ name: "performance.jsonl", mimeType: "application/json", buffer });
    await page.locator("#stop:enabled").waitFor();
    await page.locator("#stop:disabled").waitFor({ timeout: 90_000 });
  };
  for (const { motion, lines } of parts) {
    await play(lines);
    await page.locator("#name").fill(motion);
    await page.locator("#secs").fill("10");
    await page.locator("#cut").click();
  }
  assert.equal(await page.locator("#classes li").count(), 2);
  await page.locator("#train").click();
  await page.getByText("Trained in").waitFor();
  await page.getByText(/Recognises (wave, bow|bow, wave)/).waitFor();

  await play(lines);
  const events = await page.locator("#events li").allTextContents();
  for (const motion of ["wave", "bow"]) assert.ok(events.some((text) => text.startsWith(motion)), events.join("; "));

  const [download] = await Promise.all([page.waitForEvent("download"), page.locator("#save-index").click()]);
  const bytes = readFileSync(await download.path());
  assert.deepEqual(morec.Index.fromBytes(bytes).classes.toSorted(), ["bow", "wave"]);
  // What was taught is there when the page is opened again, the index with it.
  await page.reload();
  await page.getByText(/Recognises (wave, bow|bow, wave)/).waitFor();
  assert.equal(await page.locator("#classes li").count(), 2);
  assert.equal(await page.locator("#bars li").count(), 2);
  await page.locator("#index-file").setInputFiles({ name: "motions.index", mimeType: "application/octet-stream", buffer: bytes });
  await page.getByText(/Recognises/).waitFor();
  assert.deepEqual(errors, []);
});

test("countdown, motion, bars and problems lie large over the picture, each in its place", { skip, timeout: 180_000 }, async () => {
  const { lines } = performance();
  await page.evaluate(() => {
    const said = (globalThis.said = { large: new Set(), bars: new Set() });
    const note = () => {
      said.large.add(document.getElementById("large").textContent);
      for (const text of document.querySelectorAll("#bars span")) said.bars.add(text.textContent);
    };
    new MutationObserver(note).observe(document.querySelector(".stage"), { subtree: true, childList: true, characterData: true });
  });
  const buffer = Buffer.from(lines.join("\n"));
  await page.locator("#source-file").setInputFiles({ name: "performance.jsonl", mimeType: "application/json", buffer });
  await page.locator("#stop:enabled").waitFor();
  await page.locator("#name").fill("hop");
  await page.locator("#secs").fill("1");
  await page.locator("#record").click();
  await page.getByText("Kept: 1 of hop").waitFor();
  await page.locator("#stop:disabled").waitFor({ timeout: 90_000 });
  const said = await page.evaluate(() => ({ large: [...globalThis.said.large], bars: [...globalThis.said.bars] }));
  for (const text of ["3", "2", "1", "hop"]) assert.ok(said.large.includes(text), said.large.join("; "));
  for (const motion of ["wave", "bow"]) {
    assert.ok(said.large.includes(motion), said.large.join("; "));
    assert.ok(said.bars.includes(`${motion}: recognised`), said.bars.join("; "));
  }
  // A person of 500, too tall for centimetres and too small for millimetres: what is wrong lies at the top of the picture, the bars at its
  // bottom.
  const grown = lines.map((line) => JSON.parse(line)).map(({ t, positions }) => JSON.stringify({
    t, positions: Object.fromEntries(Object.entries(positions).map(([role, place]) => [role, place.map((value) => 300 * value)])),
  }));
  await page.locator("#source-file").setInputFiles({ name: "grown.jsonl", mimeType: "application/json", buffer: Buffer.from(grown.join("\n")) });
  await page.locator("#diagnosis li").first().waitFor();
  const within = await page.evaluate(() => {
    const box = (id) => document.getElementById(id).getBoundingClientRect();
    const picture = document.querySelector(".stage").getBoundingClientRect();
    return {
      top: box("diagnosis").top - picture.top, bottom: picture.bottom - box("bars").bottom,
      apart: box("bars").top - box("diagnosis").bottom, letters: parseFloat(getComputedStyle(document.getElementById("large")).fontSize),
    };
  });
  assert.ok(Math.abs(within.top) < 1 && Math.abs(within.bottom) < 1 && within.apart > 0 && within.letters >= 46, JSON.stringify(within));
  await page.locator("#stop").click();
  // What was wrong goes with its source.
  await page.locator("#source-file").setInputFiles({ name: "again.jsonl", mimeType: "application/json", buffer });
  await page.locator("#diagnosis li").first().waitFor({ state: "detached" });
  await page.locator("#stop").click();
  assert.deepEqual(errors, []);
});

test("the page is used by keyboard and fits a phone in both themes", { skip }, async () => {
  await page.reload();
  await page.keyboard.press("Tab");
  assert.equal(await page.evaluate(() => document.activeElement.id), "camera");
  for (const colorScheme of ["light", "dark"]) {
    await page.emulateMedia({ colorScheme });
    const { wide, colour } = await page.evaluate(() => ({
      wide: document.documentElement.scrollWidth > innerWidth, colour: getComputedStyle(document.body).backgroundColor,
    }));
    assert.equal(wide, false);
    assert.equal(colour, colorScheme === "light" ? "rgb(255, 255, 255)" : "rgb(24, 24, 24)");
  }
});

test("events go to the page that shows this one, and to a socket", { skip }, async () => {
  const [lines, sockets] = [[], createServer()];
  sockets.on("upgrade", (request, socket) => {
    const key = `${request.headers["sec-websocket-key"]}258EAFA5-E914-47DA-95CA-C5AB0DC85B11`;
    const accept = createHash("sha1").update(key).digest("base64");
    socket.write(`HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: ${accept}\r\n\r\n`);
    socket.on("error", () => {});
    socket.on("data", (frame) => {
      // A short text in one masked frame.
      const bytes = frame.subarray(frame[1] === 0xfe ? 8 : 6);
      const mask = frame.subarray(frame[1] === 0xfe ? 4 : 2);
      if (frame[0] === 0x81) lines.push(JSON.parse(bytes.map((byte, at) => byte ^ mask[at % 4]).toString()));
    });
  });
  sockets.listen(0, "127.0.0.1");
  await new Promise((done) => sockets.once("listening", done));
  const host = await browser.newPage();
  await host.goto(`http://127.0.0.1:${server.address().port}/style.css`);
  const detail = { class: "wave", phase: "end", score: 0.9 };
  const message = await host.evaluate(async ({ detail, port }) => {
    const frame = document.createElement("iframe");
    const query = new URLSearchParams({ host: location.origin, socket: `ws://127.0.0.1:${port}` });
    frame.src = `/index.html?${query}`;
    const loaded = new Promise((done) => (frame.onload = done));
    document.documentElement.append(frame);
    await loaded;
    const { outlets } = await frame.contentWindow.eval('import("/outlets.js")');
    const send = outlets(query);
    const message = new Promise((done) => addEventListener("message", ({ data }) => done(data)));
    await new Promise((done) => setTimeout(done, 500));
    send(detail);
    return message;
  }, { detail, port: sockets.address().port });
  assert.deepEqual(message, { type: "morec", ...detail });
  while (!lines.length) await new Promise((done) => setTimeout(done, 20));
  assert.deepEqual(lines, [{ type: "motion", ...detail }]);
  await host.close();
  sockets.closeAllConnections();
  sockets.close();
});

test("without a body, and with a file that is none, the page says what is wrong", { skip }, async () => {
  await page.locator("#source-file").setInputFiles({ name: "no.jsonl", mimeType: "application/json", buffer: Buffer.from("no poses") });
  await page.waitForFunction(() => /not what was expected/.test(document.getElementById("source-state").textContent));
  await page.locator("#index-file").setInputFiles({ name: "no.index", mimeType: "application/octet-stream", buffer: Buffer.from("no index") });
  await page.waitForFunction(() => /index/.test(document.getElementById("state").textContent));
});

test("MediaPipe's newer package sees by a model beside it, and what is missing is said", { skip }, async () => {
  const track = (what) => page.evaluate(async (what) => {
    const { tracker } = await import("/vendor/mediapipe.js");
    const video = { videoWidth: 4, videoHeight: 3 };
    return tracker("./vendor/mediapipe", what).then(({ track }) => track(video), (error) => error.message);
  }, what);
  assert.match(await track("body"), /neither pose.js nor vision_bundle.mjs/);
  writeFileSync(join(mediapipe, "vision_bundle.mjs"), VISION);
  await page.reload();
  assert.match(await track("hand"), /there is no hand_landmarker.task/);
  writeFileSync(join(mediapipe, "hand_landmarker.task"), "four");
  const { positions, pictures, lines } = await track("hand");
  // All points are in the middle of the picture.
  assert.deepEqual(positions.right_hand.map((value) => value + 0), [0, 0, -1]);
  assert.equal(Object.keys(positions).length, 21);
  assert.equal(pictures[0].length, 21);
  assert.ok(lines.flat().every((number) => number < 21));
  assert.match(await track("feet"), /body, hand, hands, and not feet/);
});
