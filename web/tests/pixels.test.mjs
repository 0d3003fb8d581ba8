// The whole way from pixels: Chromium's camera plays a film of a photographed person who leans to one side and to the other; MediaPipe sees
// her, the page teaches, trains and recognises. Needs what `web/test` gets.
import assert from "node:assert/strict";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";

const { MOREC_PACKAGE, MOREC_TOOLS, MOREC_CHROMIUM, MOREC_PHOTOGRAPH } = process.env;
const mediapipe = fileURLToPath(new URL("../vendor/mediapipe", import.meta.url));
const missing = { Chromium: MOREC_CHROMIUM, "a photograph": MOREC_PHOTOGRAPH, MediaPipe: existsSync(join(mediapipe, "pose.js")) };
const skip = Object.entries(missing).filter(([, found]) => !found).map(([name]) => `there is no ${name} here`).join(", ") || false;
const { serve } = await import(pathToFileURL(join(MOREC_PACKAGE, "serve.js")));

/** What happens in the film, over and over: seconds, and how far the picture leans at most, in degrees. */
const STILL_SECS = 3;
const LEAN_SECS = 3;
const MOTIONS = [{ name: "lean_left", degrees: -40 }, { name: "lean_right", degrees: 40 }];
const RATE_HZ = 30;

/** The film as a row of JPEG pictures, drawn by the browser. A corner tells which motion is on: red for the first, blue for the second. */
async function film(page, photograph) {
  const pictures = await page.evaluate(async ({ photograph, motions, still, lean, rate }) => {
    const person = Object.assign(new Image(), { src: photograph });
    await person.decode();
    const canvas = new OffscreenCanvas(640, 480);
    const drawing = canvas.getContext("2d");
    const picture = async (degrees, corner) => {
      drawing.fillStyle = "#888";
      drawing.fillRect(0, 0, 640, 480);
      drawing.save();
      drawing.translate(320, 520);
      drawing.rotate((degrees * Math.PI) / 180);
      drawing.drawImage(person, -240, -480, 480, 480);
      drawing.restore();
      drawing.fillStyle = corner;
      drawing.fillRect(0, 0, 40, 40);
      const bytes = new Uint8Array(await (await canvas.convertToBlob({ type: "image/jpeg", quality: 0.9 })).arrayBuffer());
      return btoa(String.fromCharCode(...bytes));
    };
    const pictures = [];
    for (const [at, { degrees }] of motions.entries()) {
      const upright = await picture(0, "#0f0");
      for (let frame = 0; frame < still * rate; frame++) pictures.push(upright);
      for (let frame = 0; frame < lean * rate; frame++) {
        const bent = (1 - Math.cos((2 * Math.PI * frame) / (lean * rate))) / 2;
        pictures.push(await picture(degrees * bent, ["#f00", "#00f"][at]));
      }
    }
    return pictures;
  }, { photograph, motions: MOTIONS, still: STILL_SECS, lean: LEAN_SECS, rate: RATE_HZ });
  return Buffer.concat(pictures.map((picture) => Buffer.from(picture, "base64")));
}

/** Which motion the camera shows now: its number, or -1. */
const shown = (page) => page.evaluate(() => {
  const drawing = new OffscreenCanvas(1, 1).getContext("2d");
  drawing.drawImage(document.getElementById("video"), 10, 10, 20, 20, 0, 0, 1, 1);
  const [red, , blue] = drawing.getImageData(0, 0, 1, 1).data;
  return red > 128 ? 0 : blue > 128 ? 1 : -1;
});

async function until(page, motion) {
  while ((await shown(page)) !== motion) await page.waitForTimeout(50);
}

test("a film of a photograph: MediaPipe sees, the page teaches, trains and recognises", { skip, timeout: 240_000 }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "morec-pixels-"));
  const server = await serve({ port: 0, mediapipe: [mediapipe] });
  const { chromium } = createRequire(join(MOREC_TOOLS, "tools.js"))("playwright-core");
  const launch = (args) => chromium.launch({ executablePath: MOREC_CHROMIUM, args: ["--no-sandbox", ...args] });
  let browser = await launch([]);
  try {
    const camera = join(folder, "film.mjpeg");
    const photograph = `data:image/png;base64,${readFileSync(MOREC_PHOTOGRAPH).toString("base64")}`;
    writeFileSync(camera, await film(await browser.newPage(), photograph));
    await browser.close();
    browser = await launch(["--use-fake-ui-for-media-stream", "--use-fake-device-for-media-stream", `--use-file-for-fake-video-capture=${camera}`]);
    const page = await browser.newPage();
    const errors = [];
    page.on("pageerror", (error) => errors.push(String(error)));
    await page.goto(`http://127.0.0.1:${server.address().port}/`);
    await page.locator("#camera").click();
    await page.locator("#cut:enabled").waitFor({ timeout: 60_000 });

    // Two samples of each, cut out of what just happened.
    for (const round of [1, 2]) {
      for (const [number, { name }] of MOTIONS.entries()) {
        await until(page, number);
        await until(page, -1);
        await page.waitForTimeout(700);
        await page.locator("#name").fill(name);
        await page.locator("#secs").fill(String(LEAN_SECS + 1.5));
        await page.locator("#cut").click();
        assert.equal(await page.getByLabel(`Delete sample ${round} of ${name}`).count(), 1);
      }
    }
    await page.locator("#train").click();
    await page.getByText("Trained in").waitFor();

    const seen = [];
    await page.exposeFunction("saw", (name) => seen.push(name));
    await page.evaluate(() => document.addEventListener("morec", ({ detail }) => detail.phase === "end" && window.saw(detail.class)));
    await until(page, 0);
    const found = [];
    for (const number of [0, 1, 0, 1]) {
      await until(page, number);
      seen.length = 0;
      await until(page, -1);
      await page.waitForTimeout(1000 * STILL_SECS - 1000);
      found.push(...seen);
      assert.ok(seen.every((name) => name === MOTIONS[number].name), `${seen} for ${MOTIONS[number].name}`);
    }
    // How many pictures a second MediaPipe sees is up to the machine.
    assert.ok(MOTIONS.every(({ name }) => found.includes(name)) && found.length <= 4, found.join());
    assert.deepEqual(errors, []);
  } finally {
    await browser.close();
    server.close();
    rmSync(folder, { recursive: true });
  }
});
