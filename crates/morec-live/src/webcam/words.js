// Errors of browsers, in words that say what to do; for `web/` and for `--listen webcam`.

const WORDS = {
  NotAllowedError: "This page may not use the camera. Allow it beside the page's address, then start the camera again.",
  NotFoundError: "There is no camera. Connect one, then start the camera again.",
  NotReadableError: "The camera does not start: another program uses it, perhaps. Close that, then start the camera again.",
  OverconstrainedError: "The camera gives no picture of 640 by 480. Try another one.",
  NotSupportedError: "The browser cannot play this film. Films of the kinds .mp4 (H.264) and .webm are played by most.",
  QuotaExceededError: "The browser has no room to keep what was taught: save the samples as a file.",
  SyntaxError: "The file is not what was expected: lines of JSON with poses, or samples that this page saved.",
};

/** What an error means; its own words where they are ours. */
export const inWords = (error) => WORDS[error?.name] ?? String(error?.message ?? error);

/** The camera, or an error in words: browsers hide it from pages of other machines that are not encrypted. */
export function devices() {
  if (!navigator.mediaDevices) throw new Error("Browsers show cameras only to pages of this machine (http://127.0.0.1) and to encrypted ones (https).");
  return navigator.mediaDevices;
}
