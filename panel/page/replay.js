// The machine's run, played again: a slider over the whole program in both directions, the override, what each axis is
// told and where it is, the tape, and the scopes.

import { element, length, time } from "./format.js";
import { machineAt } from "./result.js";
import { TapeStrip } from "./tape.js";

const SCOPE_HEIGHT = 92;
const AXES = ["#2f78b7", "#c2571a", "#3d8f55", "#8a3fa0", "#777777"];
const MOST_OVERRIDE = { tape: 200, program: 100 }; // %; a G-code control takes no more than its program says

export class Replay {
  // result: {played, following, tape, override}; onTime(now) hears where the machine is, or null before anybody has
  // asked; onOverride(share), if there is a machine behind the page, has it run the program at another feed
  constructor(host, result, onTime, onOverride = null, share = 0) {
    Object.assign(this, { path: result.played, following: result.following, tape: result.tape, onTime, onOverride });
    this.override = result.override ?? 1;
    this.onTape = (result.program ?? "").endsWith(".wav");
    this.first = this.path.t_s[0];
    this.last = this.path.t_s.at(-1);
    this.playing = false;
    this.make(host);
    this.at(this.first + share * (this.last - this.first), share > 0);
  }

  // How far along the program, 0 to 1.
  get share() {
    return (this.t - this.first) / (this.last - this.first || 1);
  }

  make(host) {
    this.play = element("button", { class: "go", onclick: () => this.toggle() }, "Play");
    const step = Math.max(0.01, (this.last - this.first) / 2000).toFixed(3);
    this.slider = element("input", {
      type: "range", min: this.first, max: this.last, step, value: this.first, "aria-label": "Time of the program",
      oninput: () => { this.stop(); this.at(Number(this.slider.value)); },
    });
    this.speed = element("select", { "aria-label": "How fast the run is shown" },
      ...[1, 2, 5, 20, 100].map((s) => element("option", { value: s, selected: s === 5 }, `${s} ×`)));
    this.clock = element("output", { class: "clock" }, "");
    this.scopes = element("div", { class: "scopes" });
    this.choice = element("div", { class: "segments", role: "group", "aria-label": "What is drawn over the time" });
    host.replaceChildren(
      element("div", { class: "bar" }, this.play, this.speed, this.slider, this.clock, this.overriding()),
      this.dials(), this.choice, this.scopes,
    );
    this.plots = [this.positions(), this.errors(), this.feeds()].filter(Boolean);
    if (this.tape) {
      const strip = element("div", { class: "scope", "data-name": "Tape" });
      this.scopes.append(strip);
      this.strip = new TapeStrip(strip, this.tape, this.override, (t) => { this.stop(); this.at(this.first + t); });
    }
    this.choice.replaceChildren(...[...this.scopes.children].map(({ dataset }) => element("button", { onclick: () => this.show(dataset.name), "data-scope": dataset.name }, dataset.name)));
    this.show(Replay.shown);
    this.resizing = new ResizeObserver(() => this.fit());
    this.resizing.observe(this.scopes);
  }

  // Show one of the scopes, or the tape.
  show(name) {
    const names = [...this.scopes.children].map((scope) => scope.dataset.name);
    Replay.shown = names.includes(name) ? name : names[0];
    for (const scope of this.scopes.children) scope.hidden = scope.dataset.name !== Replay.shown;
    for (const button of this.choice.children) button.setAttribute("aria-pressed", String(button.dataset.scope === Replay.shown));
    this.fit();
  }

  // The feed override, 10 to 200 %: the machine runs its program again at it.
  overriding() {
    if (!this.onOverride) return null;
    const most = MOST_OVERRIDE[this.onTape ? "tape" : "program"], said = element("output", { class: "percent" }, `${Math.round(100 * this.override)} %`);
    const range = element("input", { id: "override", type: "range", min: 10, max: most, step: 5, value: Math.round(100 * this.override), "aria-valuetext": `${Math.round(100 * this.override)} %`,
      oninput: () => { said.textContent = `${range.value} %`; range.setAttribute("aria-valuetext", `${range.value} %`); },
      onchange: () => this.onOverride(Number(range.value) / 100) });
    return element("span", { class: "override" }, element("label", { for: "override" }, "Override"), range, said);
  }

  // Dials: each axis as it is told and where it is, how far it is behind, and the rest.
  dials() {
    const axes = ["X", "Y", "Z"];
    const cells = () => Object.fromEntries(axes.map((axis) => [axis, element("td", {}, "–")]));
    this.told = cells();
    this.stands = cells();
    this.behind = cells();
    const rows = [["commanded", this.told], ["actual", this.stands], ["behind", this.behind]];
    const table = element("table", { class: "axes" },
      element("caption", { class: "hush" }, "Axes, mm"),
      element("thead", {}, element("tr", {}, element("td", {}), ...axes.map((axis) => element("th", { scope: "col" }, axis)))),
      element("tbody", {}, ...rows.map(([name, row]) => element("tr", {}, element("th", { scope: "row" }, name), ...axes.map((axis) => row[axis])))));
    this.meter = element("i");
    this.error = element("b", {}, "–");
    this.feed = element("b", {}, "–");
    this.tool = element("b", { class: "tool" }, "–");
    this.done = element("b", {}, "–");
    this.left = element("b", {}, "–");
    const dial = (name, ...what) => element("div", { class: "dial" }, element("span", {}, name), ...what);
    return element("div", { class: "dro" }, table, dial("Following error", this.error, element("span", { class: "meter", "aria-hidden": "true" }, this.meter)),
      dial("Feed", this.feed), dial("Tool", this.tool), dial("Done", this.done), dial("Left", this.left));
  }

  close() {
    this.stop();
    this.resizing.disconnect();
    for (const plot of this.plots) plot.destroy();
  }

  // `low`: where the scale begins; null: by the values
  plot(name, title, times, series, unit, low = null) {
    const host = element("div", { class: "scope", "data-name": name }, element("h3", {}, title));
    this.scopes.append(host);
    const style = getComputedStyle(document.documentElement);
    const soft = style.getPropertyValue("--soft").trim(), line = style.getPropertyValue("--line").trim();
    const axis = { stroke: soft, grid: { stroke: line, width: 1 }, ticks: { show: false }, font: "11px system-ui", size: 22 };
    const plot = new uPlot({
      width: Math.max(200, host.clientWidth), height: SCOPE_HEIGHT,
      scales: { x: { time: false }, y: low === null ? {} : { range: (u, min, max) => [low, 1.2 * max || 1] } },
      cursor: { y: false, points: { show: false }, drag: { x: false, y: false }, bind: { click: (u) => () => { this.stop(); this.at(u.posToVal(u.cursor.left, "x")); } } },
      axes: [{ ...axis, values: (u, all) => all.map((v) => `${v} s`) }, { ...axis, size: 44, values: (u, all) => all.map((v) => `${+v.toFixed(3)}`) }],
      series: [{}, ...series.map((s) => ({ label: `${s.label} ${unit}`, stroke: s.colour, width: 1.2, dash: s.dash, points: { show: false } }))],
      hooks: { setSize: [(u) => this.mark(u)] },
    }, [times, ...series.map((s) => s.values)], host);
    plot.now = element("i", { class: "now", "aria-hidden": "true" });
    plot.over.append(plot.now);
    return plot;
  }

  positions() {
    const { t_s, x_mm, y_mm, z_mm } = this.path;
    const series = [["X", x_mm], ["Y", y_mm], ["Z", z_mm]].map(([label, values], i) => ({ label, values, colour: AXES[i] }));
    return this.plot("Axes", "X blue, Y orange, Z green, mm", t_s, series, "mm");
  }

  errors() {
    if (!this.following) return null;
    const { t_s, axes, error_mm, limit_mm } = this.following, micro = (rows) => rows.map((v) => 1000 * v);
    const errors = axes.map((label, i) => ({ label, values: micro(error_mm[i]), colour: AXES[i] }));
    const worst = Math.max(...errors.map((e) => e.values.reduce((m, v) => Math.max(m, Math.abs(v)), 0)));
    const least = limit_mm[0].reduce((m, v) => Math.min(m, v), Infinity);
    const limits = 1000 * least < 4 * worst ? [{ label: "limit", values: micro(limit_mm[0]), colour: "#ad1f2d", dash: [4, 4] }] : [];
    return this.plot("Following error", `X blue, Y orange, Z green, µm (limit from ${length(least)})`, t_s, [...errors, ...limits], "µm");
  }

  feeds() {
    const { t_s, x_mm, y_mm } = this.path, feeds = [0];
    for (let i = 1; i < t_s.length; i++) feeds.push(Math.hypot(x_mm[i] - x_mm[i - 1], y_mm[i] - y_mm[i - 1]) / (t_s[i] - t_s[i - 1] || 1));
    return this.plot("Feed", "mm/s along the path", t_s, [{ label: "feed", values: feeds, colour: AXES[0] }], "mm/s", 0);
  }

  // The time on a scope: a line over it that is moved, because to draw forty thousand places again takes longer.
  mark(u) {
    if (u.now) u.now.style.transform = `translateX(${u.valToPos(this.t, "x")}px)`;
  }

  fit() {
    for (const plot of this.plots ?? []) {
      const width = plot.root.parentElement.clientWidth;
      if (width && width !== plot.width) plot.setSize({ width, height: SCOPE_HEIGHT });
    }
    this.strip?.fit();
  }

  at(t, told = true) {
    this.t = Math.min(this.last, Math.max(this.first, t));
    const now = machineAt(this.path, this.t);
    this.slider.value = this.t;
    this.slider.setAttribute("aria-valuetext", `${time(this.t)}, X ${now.x.toFixed(2)}, Y ${now.y.toFixed(2)}, tool ${now.down ? "down" : "up"}`);
    this.clock.textContent = `${time(this.t)} / ${time(this.last)}`;
    this.feed.textContent = `${now.feed.toFixed(1)} mm/s at ${Math.round(100 * this.override)} %`;
    this.tool.textContent = now.down ? "down" : "up";
    this.tool.className = now.down ? "tool down" : "tool up";
    this.done.textContent = time(this.t - this.first);
    this.left.textContent = time(this.last - this.t);
    this.showAxes(now);
    for (const plot of this.plots ?? []) this.mark(plot);
    this.strip?.at(this.t - this.first);
    this.onTime(told ? now : null);
  }

  showAxes(now) {
    const rows = this.following;
    if (!rows) {
      for (const [axis, v] of [["X", now.x], ["Y", now.y], ["Z", now.z]]) this.stands[axis].textContent = v.toFixed(3);
      return;
    }
    const i = rowAt(rows.t_s, this.t);
    let worst = 0, most = 0, limit = 0;
    rows.axes.forEach((name, k) => {
      const axis = name.toUpperCase(), error = rows.error_mm[k][i], told = rows.demand_mm?.[k][i];
      if (!(axis in this.told)) return;
      if (told !== undefined) this.told[axis].textContent = told.toFixed(3);
      if (told !== undefined) this.stands[axis].textContent = (told - error).toFixed(3);
      this.behind[axis].textContent = length(Math.abs(error));
      if (Math.abs(error) / rows.limit_mm[k][i] >= worst) [worst, most, limit] = [Math.abs(error) / rows.limit_mm[k][i], Math.abs(error), rows.limit_mm[k][i]];
    });
    this.error.textContent = `${length(most)} of ${length(limit)}`;
    this.meter.style.width = `${Math.min(100, 100 * worst)}%`;
    this.meter.className = worst > 0.8 ? "hot" : "";
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

Replay.shown = "Axes"; // stays while results come and go

// The last row that is not after a time.
function rowAt(times, t) {
  let low = 0, high = times.length - 1;
  while (high > low) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= t) low = middle;
    else high = middle - 1;
  }
  return low;
}
