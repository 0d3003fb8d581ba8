// Keeps what was taught in the browser's own database, so that it is there when the page is opened again.

const [STORE, KEY] = ["taught", "last"];

const done = (request) => new Promise((good, bad) => {
  request.onsuccess = () => good(request.result);
  request.onerror = () => bad(request.error);
});

/** A place that keeps one value; null where the browser keeps nothing. */
export async function place(databases = globalThis.indexedDB) {
  if (!databases) return null;
  const opening = databases.open("morec", 1);
  opening.onupgradeneeded = () => opening.result.createObjectStore(STORE);
  const db = await done(opening);
  const store = (mode) => db.transaction(STORE, mode).objectStore(STORE);
  return {
    put: (value) => done(store("readwrite").put(value, KEY)),
    get: () => done(store("readonly").get(KEY)),
  };
}

/** Gives `teaching` what `place` keeps, then keeps every change there; `failed` takes an error. */
export async function keep(teaching, place, failed = () => {}) {
  const kept = await place.get();
  if (kept) {
    teaching.begin(kept.samples);
    if (kept.index) teaching.load(kept.index);
  }
  let last = Promise.resolve();
  teaching.addEventListener("change", () => {
    const value = { samples: teaching.saved(), index: teaching.index?.toBytes() ?? null };
    // In their order: the last change is what stays.
    last = last.then(() => place.put(value)).catch(failed);
  });
}
