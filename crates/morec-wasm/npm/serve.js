#!/usr/bin/env node
// `npx morec`: serves the page that teaches and recognises, on this machine.
import { existsSync, readFileSync, realpathSync, statSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { dirname, extname, join, sep } from "node:path";
import { fileURLToPath } from "node:url";
import { parseArgs } from "node:util";

const HELP = `Usage: npx morec [--port PORT] [--mediapipe FOLDER]...

Serves a page that teaches motions before the camera and recognises them. Nothing leaves this machine.

  --port PORT         the port of 127.0.0.1 (8000; 0: any that is free)
  --mediapipe FOLDER  MediaPipe's files, which see bodies and hands in pictures: unpacked npm packages, or
                      @mediapipe/tasks-vision with a model beside it. Without it, the packages installed beside morec:
                      npx -p morec -p @mediapipe/pose -p @mediapipe/hands morec`;
const TYPES = {
  ".css": "text/css", ".html": "text/html", ".js": "text/javascript", ".mjs": "text/javascript", ".wasm": "application/wasm",
};
const here = dirname(realpathSync(fileURLToPath(import.meta.url)));

/** The folders of MediaPipe's packages that were installed beside this one. */
function installed() {
  const require = createRequire(import.meta.url);
  const places = require.resolve.paths("@mediapipe/pose") ?? [];
  return ["pose", "hands"].flatMap((name) => places.map((place) => join(place, "@mediapipe", name)).filter(existsSync).slice(0, 1));
}

/** Where each path of the page is looked for; the first file that is there is it. */
const folders = (mediapipe) => [
  ["/vendor/mediapipe/", mediapipe],
  ["/vendor/morec/", [here]],
  // The parts that `morec live --listen webcam` has, too, lie beside the page's own.
  ["/vendor/", [join(here, "page")]],
  ["/", [join(here, "page")]],
];

/** The file at a path; throws if there is none. */
function fileAt(url, places) {
  const path = decodeURIComponent(url.split("?")[0]);
  const asked = path === "/" ? "/index.html" : path;
  const [prefix, roots] = places.find(([start]) => asked.startsWith(start));
  const isFile = (file, root) => file.startsWith(root + sep) && statSync(file, { throwIfNoEntry: false })?.isFile();
  for (const root of roots) {
    const file = join(root, asked.slice(prefix.length));
    if (isFile(file, root)) return file;
  }
  throw new Error(`no file ${asked}`);
}

/** Serves the page on a port of this machine, with MediaPipe's files from the first folder that has each: the server, listening. */
export async function serve({ port = 8000, mediapipe = installed() } = {}) {
  const places = folders(mediapipe);
  const server = createServer(({ url }, response) => {
    try {
      const file = fileAt(url, places);
      const bytes = readFileSync(file);
      response.writeHead(200, { "content-type": TYPES[extname(file)] ?? "application/octet-stream" }).end(bytes);
    } catch {
      response.writeHead(404).end("no such file");
    }
  });
  await new Promise((done, failed) => server.once("error", failed).listen(port, "127.0.0.1", done));
  return server;
}

async function main() {
  const { values } = parseArgs({
    options: { port: { type: "string", default: "8000" }, mediapipe: { type: "string", multiple: true }, help: { type: "boolean", short: "h" } },
  });
  if (values.help) return console.log(HELP);
  for (const folder of values.mediapipe ?? []) if (!existsSync(folder)) throw new Error(`--mediapipe ${folder}: there is no such folder`);
  const port = Number(values.port);
  if (!Number.isInteger(port) || port < 0 || port > 65535) throw new Error(`--port ${values.port}: it is a number from 0 to 65535`);
  const mediapipe = (values.mediapipe ?? installed()).map((folder) => realpathSync(folder));
  const server = await serve({ port, mediapipe });
  console.log(`The page is http://127.0.0.1:${server.address().port}/ until Ctrl+C.`);
  if (mediapipe.length === 0) console.log("Without MediaPipe it reads recorded landmarks only; `npx morec --help` says how to get it.");
}

if (process.argv[1] && realpathSync(process.argv[1]) === fileURLToPath(import.meta.url)) {
  main().catch((error) => {
    console.error(`morec: ${error.message}`);
    process.exit(1);
  });
}
