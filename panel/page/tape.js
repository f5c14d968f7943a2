// The tape: four tracks over the time of the program, each with its level, its deviation and its lock, and the damage
// where it is. A press or a drag on it, or the arrow keys, go to that place of the program.

import { element, time } from "./format.js";

const TRACK = 32; // height of a track, CSS pixels
const HEAD = 14; // and of the times below

export class TapeStrip {
  // tape: see panel.tape_levels; `first` is when the program begins on the slider, `rate` how fast the tape runs
  constructor(host, tape, rate, go) {
    Object.assign(this, { tape, rate, go, t: 0 });
    this.canvas = element("canvas", { class: "tape", tabindex: "0", role: "slider", "aria-label": "The tape's tracks; arrow keys go along it, Page up and Page down from damage to damage",
      "aria-valuemin": "0", "aria-valuemax": this.seconds.toFixed(2) });
    this.now = element("i", { class: "now", "aria-hidden": "true" });
    this.state = element("p", { class: "tracks" });
    host.append(element("h3", {}, "level: band · deviation: line · lock: green, red where the phase is in doubt · damage: red"), element("div", { class: "strip" }, this.canvas, this.now), this.state, this.damages());
    const scrub = (event) => this.go(this.seconds * Math.min(1, Math.max(0, (event.clientX - this.canvas.getBoundingClientRect().left) / this.canvas.clientWidth)));
    this.canvas.addEventListener("pointerdown", (event) => { this.canvas.setPointerCapture(event.pointerId); scrub(event); });
    this.canvas.addEventListener("pointermove", (event) => event.buttons && scrub(event));
    this.canvas.addEventListener("keydown", (event) => this.key(event));
  }

  get seconds() {
    return this.tape.duration_s / this.rate;
  }

  key(event) {
    const marks = this.tape.damage.map((one) => one.from_s / this.rate), s = this.seconds;
    const to = {
      ArrowLeft: () => this.t - s / 100, ArrowRight: () => this.t + s / 100, Home: () => 0, End: () => s,
      PageDown: () => marks.find((t) => t > this.t + 1e-3) ?? this.t, PageUp: () => marks.findLast((t) => t < this.t - 1e-3) ?? this.t,
    }[event.key];
    if (!to) return;
    event.preventDefault();
    this.go(Math.min(s, Math.max(0, to())));
  }

  // Damages as buttons that go there.
  damages() {
    const { damage } = this.tape;
    if (!damage.length) return element("p", { class: "hushed" }, "no damage: every track keeps its level");
    return element("ul", { class: "damage", "aria-label": "Damage on the tape" }, ...damage.slice(0, 12).map((one) => element("li", {}, element("button", { class: "plain", onclick: () => this.go(one.from_s / this.rate) },
      `${one.track} down to ${Math.round(100 * one.share)} % at ${(one.from_s / this.rate).toFixed(2)} s, for ${Math.round(1000 * (one.to_s - one.from_s))} ms`))),
      damage.length > 12 ? element("li", { class: "hushed" }, `and ${damage.length - 12} more`) : null);
  }

  fit() {
    const { canvas } = this, ratio = devicePixelRatio, width = Math.round(canvas.clientWidth * ratio);
    const height = Math.round((this.tape.tracks.length * TRACK + HEAD) * ratio);
    if (!width || (canvas.width === width && canvas.height === height)) return;
    canvas.width = width;
    canvas.height = height;
    this.draw();
    this.at(this.t);
  }

  draw() {
    const { canvas, tape } = this, context = canvas.getContext("2d"), ratio = devicePixelRatio, style = getComputedStyle(document.documentElement);
    const colour = (name) => style.getPropertyValue(name).trim();
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const width = canvas.width / ratio, columns = tape.t_s.length, step = width / columns;
    context.clearRect(0, 0, width, canvas.height / ratio);
    const most = Math.max(1e-9, ...tape.level.flat()), swing = Math.max(1, ...(tape.deviation_hz ?? []).flat().map(Math.abs));
    tape.tracks.forEach((name, i) => {
      const middle = i * TRACK + TRACK / 2, half = TRACK / 2 - 4, axis = i - 1;
      const label = () => {
        context.font = "10px system-ui, sans-serif";
        context.fillStyle = colour("--text");
        context.textAlign = "left";
        context.fillText(name, 5, middle - half + 9);
      };
      context.fillStyle = colour("--band");
      context.beginPath();
      tape.level[i].forEach((level, k) => context.rect(k * step, middle - (half * level) / most, step + 0.5, (2 * half * level) / most));
      context.fill();
      // the lock, below the band: in doubt from a quarter of a cycle on
      const lock = axis < 0 ? null : tape.lock?.[axis];
      for (const [ink, holds] of [["--good", (v) => v < 0.25], ["--hot", (v) => v >= 0.25]]) {
        context.fillStyle = colour(ink);
        if (lock) lock.forEach((v, k) => { if (holds(v)) context.fillRect(k * step, (i + 1) * TRACK - 3, step + 0.5, 2); });
      }
      const deviation = axis < 0 ? null : tape.deviation_hz?.[axis];
      if (deviation) {
        context.strokeStyle = colour("--text");
        context.lineWidth = 1;
        context.beginPath();
        deviation.forEach((hz, k) => context.lineTo((k + 0.5) * step, middle - (half * hz) / swing));
        context.stroke();
      }
      label();
    });
    context.fillStyle = colour("--hot");
    for (const one of tape.damage) {
      const i = tape.tracks.indexOf(one.track), x = (one.from_s / tape.duration_s) * width;
      context.fillRect(x - 1, i * TRACK + 1, Math.max(2.5, ((one.to_s - one.from_s) / tape.duration_s) * width), TRACK - 5);
    }
    context.fillStyle = colour("--soft");
    context.font = "11px system-ui, sans-serif";
    for (let k = 0; k <= 6; k++) {
      context.textAlign = k === 0 ? "left" : k === 6 ? "right" : "center";
      context.fillText(`${((k / 6) * this.seconds).toFixed(this.seconds < 60 ? 1 : 0)} s`, (k / 6) * width, tape.tracks.length * TRACK + 11);
    }
  }

  at(t) {
    this.t = t;
    this.now.style.transform = `translateX(${(t / this.seconds) * this.canvas.clientWidth}px)`;
    this.canvas.setAttribute("aria-valuenow", t.toFixed(2));
    this.canvas.setAttribute("aria-valuetext", `${time(t)} of ${time(this.seconds)}`);
    const k = Math.min(this.tape.t_s.length - 1, Math.max(0, Math.floor((t / this.seconds) * this.tape.t_s.length)));
    const words = this.tape.tracks.map((name, i) => this.words(name, i, k));
    this.state.replaceChildren(...words.map(([text, bad]) => element("span", { class: bad ? "bad" : "" }, text)));
  }

  // What a track is like in a stretch, and whether something is wrong there.
  words(name, i, k) {
    const { level, deviation_hz: deviation, lock } = this.tape, db = 20 * Math.log10(Math.max(level[i][k], 1e-5));
    const parts = [`${name} ${db.toFixed(0)} dB`];
    if (i > 0 && deviation?.[i - 1]) parts.push(`${deviation[i - 1][k] >= 0 ? "+" : "−"}${Math.abs(deviation[i - 1][k]).toFixed(0)} Hz`);
    const inDoubt = i > 0 && lock?.[i - 1] && lock[i - 1][k] >= 0.25;
    if (i > 0 && lock) parts.push(inDoubt ? "in doubt" : "locked");
    return [parts.join(", "), inDoubt];
  }
}
