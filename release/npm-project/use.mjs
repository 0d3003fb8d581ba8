// The demo in plain Node: two clips teach, a third is recognised.
import { readFileSync } from "node:fs";
import { read, train } from "morec";

const open = (name) => read(readFileSync(name), name);
const index = train([open("signals_1.mclip"), open("signals_3.mclip")], readFileSync("labels.tsv", "utf8"), { everyday: "never" });
const found = index.recognize(open("signals_2.mclip"));
console.log(`${found.length} motions, ${index.classes.length} classes`);
if (found.length < 10 || index.classes.length !== 7) process.exit(1);
