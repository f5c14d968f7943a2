// The machine's run, played again: a slider over the whole program in both directions, its dials, and three scopes.

import { element, length, time } from "./format.js";
import { machineAt } from "./result.js";

const SCOPE_HEIGHT = 96;
const AXES = ["#2f78b7", "#c2571a", "#3d8f55", "#8a3fa0", "#777777"];

export class Replay {
  // result: {played, following}; onTime(now) hears where the machine is, or null before anybody has asked
  constructor(host, result, onTime) {
    this.path = result.played;
    this.following = result.following;
    this.tape = result.tape;
    this.onTime = onTime;
    this.first = this.path.t_s[0];
    this.last = this.path.t_s.at(-1);
    this.playing = false;
    this.make(host);
    this.at(this.first, false);
  }

  make(host) {
    this.play = element("button", { class: "go", onclick: () => this.toggle() }, "Play");
    const step = Math.max(0.01, (this.last - this.first) / 2000).toFixed(3);
    this.slider = element("input", {
      type: "range", min: this.first, max: this.last, step, value: this.first, "aria-label": "Time of the program",
      oninput: () => { this.stop(); this.at(Number(this.slider.value)); },
    });
    this.speed = element("select", { "aria-label": "Speed of the replay, or override" },
      ...[0.1, 0.5, 1, 2, 5, 20].map((s) => element("option", { value: s, selected: s === 5 }, `${s * 100} %`)));
    this.clock = element("output", {}, "");
    this.dials = Object.fromEntries(["X", "Y", "Z", "feed", "tool", "error", "left"].map((name) => [name, element("b", {}, "–")]));
    const dial = (name) => element("span", {}, `${name === "left" ? "time left" : name === "error" ? "following error" : name} `, this.dials[name]);
    this.scopes = element("div", { class: this.tape ? "scopes four" : "scopes" });
    host.replaceChildren(
      element("div", { class: "bar" }, this.play, this.speed, this.slider, this.clock),
      element("div", { class: "dro" }, ...Object.keys(this.dials).map(dial)),
      this.scopes,
    );
    this.plots = [this.positions(), this.errors(), this.feeds(), this.levels()].filter(Boolean);
    this.resizing = new ResizeObserver(() => this.fit());
    this.resizing.observe(this.scopes);
  }

  close() {
    this.stop();
    this.resizing.disconnect();
    for (const plot of this.plots) plot.destroy();
  }

  // `low`: where the scale begins; null: by the values
  plot(title, times, series, unit, low = null) {
    const host = element("div", { class: "scope" }, element("h3", {}, title));
    this.scopes.append(host);
    const style = getComputedStyle(document.documentElement);
    const soft = style.getPropertyValue("--soft").trim(), line = style.getPropertyValue("--line").trim();
    const axis = { stroke: soft, grid: { stroke: line, width: 1 }, ticks: { show: false }, font: "11px system-ui", size: 22 };
    return new uPlot({
      width: Math.max(200, host.clientWidth), height: SCOPE_HEIGHT,
      scales: { x: { time: false }, y: low === null ? {} : { range: (u, min, max) => [low, 1.2 * max || 1] } },
      cursor: { y: false, points: { show: false }, drag: { x: false, y: false }, bind: { click: (u) => () => { this.stop(); this.at(u.posToVal(u.cursor.left, "x")); } } },
      axes: [{ ...axis, values: (u, all) => all.map((v) => `${v} s`) }, { ...axis, size: 44, values: (u, all) => all.map((v) => `${+v.toFixed(3)}`) }],
      series: [{}, ...series.map((s) => ({ label: `${s.label} ${unit}`, stroke: s.colour, width: 1.2, dash: s.dash, points: { show: false } }))],
      hooks: { draw: [(u) => this.mark(u)] },
    }, [times, ...series.map((s) => s.values)], host);
  }

  positions() {
    const { t_s, x_mm, y_mm, z_mm } = this.path;
    const series = [["X", x_mm], ["Y", y_mm], ["Z", z_mm]].map(([label, values], i) => ({ label, values, colour: AXES[i] }));
    return this.plot("X blue, Y orange, Z green, mm", t_s, series, "mm");
  }

  errors() {
    if (!this.following) return null;
    const { t_s, axes, error_mm, limit_mm } = this.following, micro = (rows) => rows.map((v) => 1000 * v);
    const errors = axes.map((label, i) => ({ label, values: micro(error_mm[i]), colour: AXES[i] }));
    const worst = Math.max(...errors.map((e) => e.values.reduce((m, v) => Math.max(m, Math.abs(v)), 0)));
    const least = limit_mm[0].reduce((m, v) => Math.min(m, v), Infinity);
    this.limit = 1000 * least;
    const limits = this.limit < 4 * worst ? [{ label: "limit", values: micro(limit_mm[0]), colour: "#ad1f2d", dash: [4, 4] }] : [];
    return this.plot(`following error, µm (limit ${length(least)})`, t_s, [...errors, ...limits], "µm");
  }

  feeds() {
    const { t_s, x_mm, y_mm } = this.path, feeds = [0];
    for (let i = 1; i < t_s.length; i++) feeds.push(Math.hypot(x_mm[i] - x_mm[i - 1], y_mm[i] - y_mm[i - 1]) / (t_s[i] - t_s[i - 1] || 1));
    return this.plot("feed in mm/s", t_s, [{ label: "feed", values: feeds, colour: AXES[0] }], "mm/s", 0);
  }

  levels() {
    if (!this.tape) return null;
    const { t_s, tracks, level } = this.tape;
    const series = tracks.map((label, i) => ({ label, values: level[i], colour: AXES[(i + 4) % 5] }));
    return this.plot("levels of the tape's tracks", t_s, series, "", 0);
  }

  mark(u) {
    const x = Math.round(u.valToPos(this.t, "x", true)), { ctx, bbox } = u;
    ctx.save();
    ctx.strokeStyle = "#c2570c";
    ctx.lineWidth = devicePixelRatio;
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
    ctx.restore();
  }

  fit() {
    for (const plot of this.plots) {
      const width = plot.root.parentElement.clientWidth;
      if (width && width !== plot.width) plot.setSize({ width, height: SCOPE_HEIGHT });
    }
  }

  at(t, told = true) {
    this.t = Math.min(this.last, Math.max(this.first, t));
    const now = machineAt(this.path, this.t);
    this.slider.value = this.t;
    this.slider.setAttribute("aria-valuetext", `${time(this.t)}, X ${now.x.toFixed(2)}, Y ${now.y.toFixed(2)}`);
    this.clock.textContent = `${time(this.t)} / ${time(this.last)}`;
    const { dials } = this;
    dials.X.textContent = now.x.toFixed(3);
    dials.Y.textContent = now.y.toFixed(3);
    dials.Z.textContent = now.z.toFixed(3);
    dials.feed.textContent = `${now.feed.toFixed(1)} mm/s`;
    dials.tool.textContent = now.down ? "down" : "up";
    dials.tool.className = now.down ? "down" : "";
    dials.left.textContent = time(this.last - this.t);
    dials.error.textContent = this.errorNow();
    for (const plot of this.plots ?? []) plot.redraw(false);
    this.onTime(told ? now : null);
  }

  errorNow() {
    if (!this.following) return "–";
    const { t_s, error_mm } = this.following;
    const i = Math.min(t_s.length - 1, Math.max(0, t_s.findIndex((s) => s >= this.t)));
    return length(Math.max(...error_mm.map((axis) => Math.abs(axis[i]))));
  }

  toggle() {
    if (this.playing) return this.stop();
    this.playing = true;
    this.play.textContent = "Pause";
    if (this.t >= this.last) this.at(this.first);
    let before = performance.now();
    const tick = (now) => {
      if (!this.playing) return;
      this.at(this.t + ((now - before) / 1000) * Number(this.speed.value));
      before = now;
      if (this.t >= this.last) return this.stop();
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  stop() {
    this.playing = false;
    this.play.textContent = "Play";
  }
}
