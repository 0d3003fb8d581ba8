"use strict";
const at = (id) => document.getElementById(id);
const player = at("player"), stage = at("stage"), lanes = at("lanes"), list = at("clips"), film = at("film");
const view = { yaw: 0.6, tilt: 0.25, zoom: 1 };
let clip = null, secs = 0, playing = true, last = 0;

function open(number) {
  clip = clips[number];
  if (!clip.xyz) {
    const text = atob(clip.places), bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
    const view16 = new DataView(bytes.buffer);
    clip.xyz = new Float32Array(bytes.length / 2);
    for (let i = 0; i < clip.xyz.length; i++) clip.xyz[i] = view16.getInt16(2 * i, true) * clip.unit_metres;
    clip.height = 0.5 * clip.size;
    for (let i = 1; i < clip.xyz.length; i += 3) clip.height = Math.max(clip.height, clip.xyz[i]);
  }
  secs = 0;
  at("film-note").textContent = "";
  if (clip.video && film.getAttribute("src") !== clip.video.address) film.src = clip.video.address;
  at("time").max = Math.max(0.01, (clip.frames - 1) / clip.rate);
  for (const [i, button] of [...(list?.children ?? [])].entries()) {
    if (i === number) button.setAttribute("aria-current", "true"); else button.removeAttribute("aria-current");
  }
  if (!list) at("shown").textContent = clip.name;
  const marks = at("marks");
  marks.replaceChildren();
  for (const [kind, list] of [["label", clip.labels], ["detection", clip.detections]]) {
    for (const [name, start, stop] of list) {
      const item = document.createElement("li"), button = document.createElement("button");
      button.textContent = `${start.toFixed(2)}–${stop.toFixed(2)} s  ${name} (${kind})`;
      button.onclick = () => { secs = start; draw(); };
      item.append(button);
      marks.append(item);
    }
  }
  draw();
}

function sized(canvas) {
  const scale = window.devicePixelRatio || 1, box = canvas.getBoundingClientRect();
  canvas.width = Math.max(1, Math.round(box.width * scale));
  canvas.height = Math.max(1, Math.round(box.height * scale));
  const pen = canvas.getContext("2d");
  pen.setTransform(scale, 0, 0, scale, 0, 0);
  return [pen, box.width, box.height];
}

const ink = () => getComputedStyle(document.body).color;

function draw() {
  if (!clip || !clip.frames) return;
  const [pen, width, height] = sized(stage);
  // Between two frames a joint goes straight.
  const exact = Math.min(clip.frames - 1, Math.max(0, secs * clip.rate + 1e-6));
  const frame = Math.floor(exact), part = exact - frame;
  const joints = clip.parents.length, from = 3 * joints * frame;
  const next = 3 * joints * Math.min(clip.frames - 1, frame + 1);
  const value = (i) => (1 - part) * clip.xyz[from + i] + part * clip.xyz[next + i];
  const scale = view.zoom * 0.8 * height / Math.max(clip.size, clip.height);
  const [sy, cy, st, ct] = [Math.sin(view.yaw), Math.cos(view.yaw), Math.sin(view.tilt), Math.cos(view.tilt)];
  // The camera follows the first joint over the floor.
  const [ox, oz] = [value(0), value(2)];
  const seen = (x, y, z) => {
    const right = cy * (x - ox) - sy * (z - oz), away = sy * (x - ox) + cy * (z - oz);
    return [width / 2 + scale * right, 0.9 * height - scale * (ct * y + st * -away)];
  };
  pen.strokeStyle = "#8886";
  pen.lineWidth = 1;
  const m = clip.size, fx = m * Math.round(ox / m), fz = m * Math.round(oz / m), reach = 3 * m;
  for (let k = -reach; k <= reach + m / 2; k += m) {
    for (const [a, b] of [[[fx + k, fz - reach], [fx + k, fz + reach]], [[fx - reach, fz + k], [fx + reach, fz + k]]]) {
      pen.beginPath();
      pen.moveTo(...seen(a[0], 0, a[1]));
      pen.lineTo(...seen(b[0], 0, b[1]));
      pen.stroke();
    }
  }
  const colour = ink();
  const place = (k) => seen(value(3 * k), value(3 * k + 1), value(3 * k + 2));
  const sided = (side) => side > 0 ? "#3d7bc8" : side < 0 ? "#c8553d" : colour;
  pen.lineWidth = 3;
  for (const [a, b] of clip.lines) {
    pen.strokeStyle = sided(clip.sides[a] === clip.sides[b] ? clip.sides[a] : 0);
    pen.beginPath();
    pen.moveTo(...place(a));
    pen.lineTo(...place(b));
    pen.stroke();
  }
  for (let j = 0; j < joints; j++) {
    pen.strokeStyle = pen.fillStyle = sided(clip.sides[j] ?? clip.sides[clip.parents[j]] ?? 0);
    const [x, y] = place(j);
    if (clip.parents[j] !== null) {
      pen.beginPath();
      pen.moveTo(...place(clip.parents[j]));
      pen.lineTo(x, y);
      pen.stroke();
    } else {
      pen.fillRect(x - 2, y - 2, 4, 4);
    }
  }
  at("time").value = secs;
  const under = clip.labels.concat(clip.detections).filter(([, start, stop]) => start <= secs && secs < stop);
  const names = [...new Set(under.map(([name]) => name))].join(", ");
  at("now").textContent = `${secs.toFixed(2)} of ${(clip.frames / clip.rate).toFixed(2)} s  ${names}`;
  drawLanes();
  follow();
}

/** The video at the moment of the clip: it plays by itself, and is put right where it is off. */
function follow() {
  const of = clip.video;
  film.hidden = at("sound").hidden = !of;
  if (!of) return film.pause();
  const wanted = secs + of.offset, within = wanted >= 0 && !(wanted >= film.duration), runs = playing && within;
  film.style.opacity = within ? 1 : 0.2;
  film.playbackRate = Number(at("speed").value);
  if (runs && film.paused) film.play().catch(() => {});
  if (!runs && !film.paused) film.pause();
  if (within && !film.seeking && Math.abs(film.currentTime - wanted) > (runs ? 0.1 : 0.01)) film.currentTime = wanted;
}

film.onerror = () => {
  if (clip?.video) at("film-note").textContent = `The video ${clip.video.address} is not where this page looks for it, or this browser cannot play it.`;
};
film.onloadeddata = () => { at("film-note").textContent = ""; };
at("sound").onchange = (event) => { film.muted = !event.target.checked; };

function hue(name) {
  let sum = 0;
  for (const letter of name) sum = (sum * 31 + letter.codePointAt(0)) % 360;
  return `hsl(${sum} 55% 50%)`;
}

function drawLanes() {
  const [pen, width, height] = sized(lanes), whole = clip.frames / clip.rate;
  pen.font = "12px sans-serif";
  for (const [row, list] of [[0, clip.labels], [1, clip.detections]]) {
    const top = 2 + row * height / 2, tall = height / 2 - 4;
    pen.fillStyle = "#8882";
    pen.fillRect(0, top, width, tall);
    for (const [name, start, stop] of list) {
      const x = width * start / whole, w = Math.max(2, width * (stop - start) / whole);
      pen.fillStyle = hue(name);
      pen.fillRect(x, top, Math.max(1, w - 1), tall);
      // A name that has no room is in the list, and beside the time while it lasts.
      if (pen.measureText(name).width + 7 > w) continue;
      pen.fillStyle = "#fff";
      pen.fillText(name, x + 3, top + tall / 2 + 4);
    }
  }
  pen.fillStyle = ink();
  pen.fillRect(width * secs / whole - 1, 0, 2, height);
}

function tick(now) {
  const step = Math.min(0.1, (now - last) / 1000);
  last = now;
  if (playing && clip && clip.frames) {
    secs += step * Number(at("speed").value);
    if (secs >= clip.frames / clip.rate) secs = 0;
    draw();
  }
  requestAnimationFrame(tick);
}

function toggle() {
  playing = !playing;
  at("play").textContent = playing ? "Pause" : "Play";
  if (clip) draw();
}

if (list) {
  clips.forEach((other, number) => {
    const button = document.createElement("button");
    button.textContent = other.name;
    button.onclick = () => open(number);
    list.append(button);
  });
} else {
  const show = (number) => { player.hidden = false; playing = true; at("play").textContent = "Pause"; open(number); };
  for (const element of document.querySelectorAll("[data-motion]")) {
    const number = Number(element.dataset.motion);
    element.tabIndex = 0;
    element.setAttribute("role", "button");
    element.onclick = () => show(number);
    element.onkeydown = (event) => { if (event.key === "Enter") show(number); };
  }
  at("close").onclick = () => { player.hidden = true; clip = null; film.pause(); };
}
at("play").onclick = toggle;
at("time").oninput = () => { secs = Number(at("time").value); draw(); };
let drag = null;
stage.onpointerdown = (event) => { drag = [event.clientX, event.clientY]; stage.setPointerCapture(event.pointerId); };
stage.onpointerup = () => { drag = null; };
stage.onpointermove = (event) => {
  if (!drag) return;
  view.yaw += (event.clientX - drag[0]) / 150;
  view.tilt = Math.min(1.5, Math.max(-0.2, view.tilt + (event.clientY - drag[1]) / 150));
  drag = [event.clientX, event.clientY];
  draw();
};
stage.onwheel = (event) => {
  event.preventDefault();
  view.zoom = Math.min(8, Math.max(0.2, view.zoom * Math.exp(-event.deltaY / 500)));
  draw();
};
lanes.onpointerdown = (event) => {
  const box = lanes.getBoundingClientRect();
  secs = (event.clientX - box.left) / box.width * clip.frames / clip.rate;
  draw();
};
document.addEventListener("keydown", (event) => {
  // On a page with more than the player, keys are the player's where it has the focus.
  if (!clip || document.body.children.length > 2 && !player.contains(event.target)) return;
  if (event.target.tagName === "BUTTON" || event.target.tagName === "SELECT") return;
  const steps = { ArrowLeft: -1, ArrowRight: 1 };
  if (event.key === " ") toggle();
  else if (event.key in steps) secs = Math.min((clip.frames - 1) / clip.rate, Math.max(0, secs + steps[event.key] / clip.rate));
  else return;
  event.preventDefault();
  draw();
});
window.onresize = draw;
if (list && clips.length) open(0);
requestAnimationFrame(tick);
