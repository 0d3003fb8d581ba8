// What lies large over the picture, for somebody who stands two metres away from it: countdown, recognised motion, a bar for each class,
// problems. For `web/` and for `--listen webcam`.
import { Nearness } from "./nearness.js";

/** Replaces a text that differs: screen readers say what is replaced. */
const write = (element, text) => {
  if (element.textContent !== text) element.textContent = text;
};

/** The elements `large`, `bars` and `diagnosis` of a page, within one element, which the button `fill` shows alone. */
export class Stage {
  #near = new Nearness();
  #said = "";
  #at;

  constructor(at = (id) => document.getElementById(id)) {
    this.#at = at;
    at("fill").hidden = !document.fullscreenEnabled;
    at("fill").addEventListener("click", () => at("large").parentElement.requestFullscreen().catch(console.warn));
  }

  /** Shows a bar for each of these classes. */
  begin(classes) {
    this.#near.begin(classes);
    this.#at("bars").replaceChildren(...this.#near.rows.map(() => {
      const row = document.createElement("li");
      row.append(document.createElement("meter"), " ", document.createElement("span"));
      return row;
    }));
    this.#show();
  }

  /** Time goes on, seconds. */
  pass(secs) {
    this.#near.pass(secs);
    this.#show();
  }

  /** Takes an event of a recogniser. */
  take(event) {
    this.#near.take(event);
    this.#show();
  }

  /** Says `text` in place of what was recognised, until an empty text. */
  say(text) {
    this.#said = text;
    this.#show();
  }

  /** Shows what is wrong with the stream, a sentence each. */
  warn(sentences) {
    const list = this.#at("diagnosis");
    const text = sentences.join("\n");
    if (text === (list.dataset.said ?? "")) return;
    list.dataset.said = text;
    list.replaceChildren(...sentences.map((sentence) => Object.assign(document.createElement("li"), { textContent: sentence })));
  }

  #show() {
    this.#near.rows.forEach(({ name, share, word }, number) => {
      const [meter, text] = this.#at("bars").children[number].children;
      meter.value = share;
      meter.setAttribute("aria-label", name);
      write(text, word ? `${name}: ${word}` : name);
    });
    const large = this.#at("large");
    write(large, this.#said || this.#near.recognised);
    large.style.setProperty("--letters", Math.max(1, [...large.textContent].length));
  }
}
