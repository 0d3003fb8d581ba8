// A page that recognises: what a bundler and the compiler of types must find.
import { type Detection, type LabelRow, read, train } from "morec";
import { trainInWorker } from "morec/worker";

const labels: LabelRow[] = [{ clip: "wave", class: "wave", start_secs: 0, stop_secs: 1 }];

export async function recognise(file: File): Promise<Detection[]> {
  const bytes = new Uint8Array(await file.arrayBuffer());
  const { bytes: index } = await trainInWorker([{ bytes, name: file.name }], labels);
  console.log(index.length);
  const clip = read(bytes, file.name);
  return train([clip], labels).recognize(clip);
}

// @ts-expect-error A label has a class.
export const wrong: LabelRow = { clip: "wave" };

document.addEventListener("drop", (event) => {
  const file = event.dataTransfer?.files[0];
  if (file) void recognise(file).then(console.log);
});
