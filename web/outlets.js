// Where events go besides the page: to other scripts of it and to whoever shows it.

/**
 * A function that sends an event to every outlet: a DOM event of the type `morec`; what the address asks for, `?host=ORIGIN` (the page
 * that has this one in a frame, or opened it, if it is of that origin) and `?socket=ADDRESS` (lines of JSON to a WebSocket); and Max, if its
 * `jweb` shows the page. Throws where `socket` is no address of a WebSocket.
 */
export function outlets(params) {
  const all = [(detail) => document.dispatchEvent(new CustomEvent("morec", { detail }))];
  const holder = window.opener ?? (window.parent === window ? null : window.parent);
  const host = params.get("host");
  if (host && holder) all.push((detail) => holder.postMessage({ type: "morec", ...detail }, host));
  if (params.has("socket")) all.push(socket(params.get("socket")));
  if (window.max?.outlet) all.push(({ class: name, phase, score }) => window.max.outlet("morec", name, phase, score));
  return (detail) => all.forEach((send) => send(detail));
}

/** Tries again two seconds after a connection was lost; what comes meanwhile is not sent. */
function socket(address) {
  let open = null;
  const connect = () => {
    const now = new WebSocket(address);
    now.onopen = () => (open = now);
    now.onclose = () => {
      open = null;
      setTimeout(connect, 2000);
    };
  };
  connect();
  return (detail) => open?.send(JSON.stringify({ type: "motion", ...detail }));
}
