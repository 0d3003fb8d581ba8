// What `npx morec` runs.
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { request } from "node:http";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";

const command = join(process.env.MOREC_PACKAGE, "serve.js");

/** Status and text of a path, as it is written: `fetch` would tidy it up. */
const get = (base, path) => new Promise((done, failed) => {
  request(base, { path }, (response) => {
    let text = "";
    response.on("data", (part) => (text += part)).on("end", () => done({ status: response.statusCode, text }));
  }).on("error", failed).end();
});

test("the page, the package and MediaPipe's files are served, and nothing else is", async () => {
  const folder = mkdtempSync(join(tmpdir(), "morec-serve-"));
  writeFileSync(join(folder, "pose.js"), "let pose;");
  const server = spawn(process.execPath, [command, "--port", "0", "--mediapipe", folder]);
  try {
    const base = await new Promise((found, failed) => {
      server.stdout.on("data", (said) => found(/http:\S+/.exec(said)[0]));
      server.once("exit", failed);
    });
    for (const [path, holds] of [
      ["/", "app.js"], ["/app.js", "vendor"], ["/vendor/camera.js", "drawLandmarks"], ["/vendor/morec/morec.js", "wasm"],
      ["/vendor/mediapipe/pose.js", "let pose;"],
    ]) {
      const { status, text } = await get(base, path);
      assert.ok(status === 200 && text.includes(holds), `${path}: ${status}`);
    }
    for (const path of ["/no", "/../package.json", "/%2e%2e/package.json", "/vendor/mediapipe/%2e%2e%2fpose.js", "/%", "/app.js/", "/%00", `/${"a".repeat(300)}`]) {
      assert.equal((await get(base, path)).status, 404, path);
    }
  } finally {
    server.kill();
    rmSync(folder, { recursive: true });
  }
});

test("what is wrong with the command line is said", () => {
  const said = (...args) => spawnSync(process.execPath, [command, ...args], { encoding: "utf8" });
  assert.match(said("--help").stdout, /Usage: npx morec/);
  for (const [args, message] of [[["--mediapipe", "no-such-folder"], /no such folder/], [["--port", "many"], /--port many/], [["--prot", "1"], /--prot/]]) {
    const { status, stderr } = said(...args);
    assert.equal(status, 1);
    assert.match(stderr, message);
  }
});
