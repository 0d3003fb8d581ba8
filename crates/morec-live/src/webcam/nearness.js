// How near each motion is, for bars that are read from two metres away. Without a page: tested in Node.

/** A motion that came so far and then was none is nearly one. */
const NEARLY = 0.5;
/** Seconds for which it is said what a motion was. */
const SAID_SECS = 2;

/** Shares and words of motions, from what a recogniser reports. */
export class Nearness {
  #rows = new Map();
  #now = 0;

  /** Shows these motions, none of them under way. */
  begin(classes) {
    this.#rows = new Map(classes.map((name) => [name, { share: 0, word: "", until: 0, motion: null }]));
  }

  /** Time goes on, seconds: what was said long enough goes. */
  pass(secs) {
    // A source that begins anew has a clock of its own.
    if (secs < this.#now) for (const row of this.#rows.values()) row.until = 0;
    this.#now = secs;
    for (const row of this.#rows.values()) {
      if (row.word && secs >= row.until) Object.assign(row, { share: 0, word: "", motion: null });
    }
  }

  /** Takes an event of a recogniser. */
  take({ class: name, phase, progress, motion }) {
    for (const [other, row] of this.#rows) {
      // The same motion seems to be another class now.
      if (row.motion === motion && other !== name) this.#end(row, "");
    }
    const row = this.#rows.get(name);
    if (!row) return;
    if (phase === "start" || phase === "update") Object.assign(row, { share: progress, word: "", motion });
    else if (phase === "cancel") this.#end(row, row.share >= NEARLY ? "nearly" : "");
    else if (phase === "end") {
      row.share = 1;
      this.#end(row, "recognised");
    }
  }

  #end(row, word) {
    Object.assign(row, { word, until: this.#now + SAID_SECS, motion: null });
    if (!word) row.share = 0;
  }

  /** Name, share from 0 to 1 and word of each motion. */
  get rows() {
    return [...this.#rows].map(([name, { share, word }]) => ({ name, share, word }));
  }

  /** The motion that was recognised last, as long as that is said. */
  get recognised() {
    return this.rows.find(({ word }) => word === "recognised")?.name ?? "";
  }
}
