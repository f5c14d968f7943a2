// The tools of the sheet: choose lines, measure a known length, drag the four corners of a sheet, begin somewhere.

import { drawArrow } from "./orders.js";

const MAGNIFIED = 5; // times, in the magnifier
const WAYS = {
  left: "Click on the junction where the head is to turn left as it comes.",
  straight: "Click on the junction where the head is to go straight on.",
  right: "Click on the junction where the head is to turn right as it comes.",
  stop: "Click on the line where the head is to stop.",
  "not-stop": "Click on what is no stop.",
  drill: "Click where a hole is to be drilled.",
};

export class Tools {
  constructor(sheet, link, ask, say) {
    Object.assign(this, { sheet, link, ask, say });
    this.name = "look";
    this.onChoose = () => {};
    sheet.layers.push((context) => this.draw(context));
    for (const button of document.querySelectorAll("[data-tool]"))
      button.addEventListener("click", () => this.take(button.dataset.tool));
    const help = document.getElementById("help"), open = document.getElementById("help-open");
    open.addEventListener("click", () => {
      help.hidden = !help.hidden;
      open.setAttribute("aria-expanded", String(!help.hidden));
      if (help.hidden) this.take("look");
    });
    this.take("look");
  }

  take(name) {
    this.name = name;
    this.places = [];
    this.magnified = null;
    this.armed = false;
    for (const button of document.querySelectorAll("[data-tool]"))
      button.setAttribute("aria-pressed", String(button.dataset.tool === name));
    this.sheet.canvas.classList.toggle("aim", name !== "look");
    this.sheet.tool = name in WAYS ? this.mark(name) : this[name]();
    if (name in WAYS) this.say(WAYS[name]);
    this.ask.close();
    if (name === "corners" && this.sheet.picture) this.beginCorners();
    if (name === "rub") this.say("Drag over the ink that is to go.");
    if (name === "bridge") this.say("Drag from one end of the line to the other.");
    if (name === "measure") this.say("Drag over a length that you know, then type it.");
    if (name === "arrow") this.say("Drag on a line: from where it is to begin, the way it is to go.");
    if (name === "start") this.say("Click on the line where the head is to begin.");
    this.sheet.ask();
  }

  look() {
    return { click: (x, y) => this.onChoose(this.sheet.numberAt(x, y)) };
  }

  measure() {
    const at = (x, y) => this.sheet.fromScreen(x, y);
    return {
      down: (x, y) => { this.places = [at(x, y), at(x, y)]; },
      move: (x, y) => { this.places[1] = at(x, y); this.magnified = [x, y]; this.sheet.ask(); return true; },
      up: () => {
        this.magnified = null;
        this.sheet.ask();
        const [a, b] = this.places;
        if (!a || Math.hypot(a[0] - b[0], a[1] - b[1]) < 5) return;
        const words = [a, b].map((p) => p.map((v) => v.toFixed(1)).join(",")).join(" ");
        this.ask.open("This length is", "200mm", async (text) => {
          const options = { "--width": null, "--dpi": null, "--flatten": null, "--known": `${words} ${text.replaceAll(" ", "")}` };
          return this.link.do({ do: "set", options });
        }, () => this.take("look"));
      },
    };
  }

  // Rub out along the way of the pointer.
  rub() {
    const at = (x, y) => this.sheet.fromScreen(x, y);
    return {
      down: (x, y) => { this.places = [at(x, y)]; },
      move: (x, y) => {
        const next = at(x, y), last = this.places.at(-1);
        const far = Math.hypot(next[0] - last[0], next[1] - last[1]) * this.sheet.view.scale;
        if (far > 6 * devicePixelRatio && this.places.length < 150) this.places.push(next);
        this.sheet.ask();
        return true;
      },
      up: () => this.correct({ as: "rub", at: this.places, width: document.getElementById("rubber").value }),
    };
  }

  bridge() {
    const at = (x, y) => this.sheet.fromScreen(x, y);
    return {
      down: (x, y) => { this.places = [at(x, y), at(x, y)]; },
      move: (x, y) => { this.places[1] = at(x, y); this.magnified = [x, y]; this.sheet.ask(); return true; },
      up: () => { this.magnified = null; this.correct({ as: "bridge", at: this.places }); },
    };
  }

  mark(name) {
    return { click: (x, y) => this.correct({ as: name, at: [this.sheet.fromScreen(x, y)] }) };
  }

  async correct(what) {
    const why = await this.link.do({ do: "correct", ...what });
    if (this.places === what.at) this.places = []; // else the next one has begun
    this.say(why ?? "corrected; run again");
    this.sheet.ask();
  }

  start() {
    return {
      click: async (x, y) => {
        const mm = this.sheet.toMm(this.sheet.fromScreen(x, y));
        if (!mm) return this.say("The sheet has no scale yet; give its width or a known length first.");
        const options = { "--lines": null, "--start": mm.map((v) => v.toFixed(2)).join(",") };
        const why = await this.link.do({ do: "set", options });
        if (why) this.say(why);
        if (this.name === "start") this.take("look");
      },
    };
  }

  // Where a line begins, and which way the head goes from there.
  arrow() {
    const at = (x, y) => this.sheet.fromScreen(x, y);
    return {
      down: (x, y) => { this.places = [this.sheet.lineAt(x, y, 12 * devicePixelRatio).px ?? at(x, y), at(x, y)]; },
      move: (x, y) => { this.places[1] = at(x, y); this.sheet.ask(); return true; },
      up: async () => {
        const [from, to] = this.places.map((px) => this.sheet.toMm(px));
        const far = this.places[0] && Math.hypot(this.places[0][0] - this.places[1][0], this.places[0][1] - this.places[1][1]) * this.sheet.view.scale;
        this.places = [];
        this.sheet.ask();
        if (!from) return this.say("The sheet has no scale yet; give its width or a known length first.");
        if (!(far > 4 * devicePixelRatio)) return this.say("Drag a little way along the line: that is the direction.");
        this.say((await this.onArrow([from, to])) ?? "");
      },
    };
  }

  beginCorners() {
    const { columns, rows } = this.sheet.picture, x = columns * 0.12, y = rows * 0.12;
    this.places = [[x, y], [columns - x, y], [columns - x, rows - y], [x, rows - y]];
    this.say("Drag the four corners onto those of the sheet (or choose one with the keys 1 to 4, and move it with the arrows), then say its size.");
    this.ask.open("Width × height", "297x210mm", async (text) => {
      const corners = this.places.map((p) => p.map((v) => v.toFixed(1)).join(",")).join(" ");
      const options = { "--width": null, "--dpi": null, "--known": null, "--flatten": `${corners}=${text.replaceAll(" ", "")}` };
      return this.link.do({ do: "set", options });
    }, () => this.take("look"));
  }

  corners() {
    let held = -1;
    this.corner = 0;
    const near = (x, y) => {
      const far = this.places.map((p) => { const s = this.sheet.toScreen(p); return Math.hypot(s[0] - x, s[1] - y); });
      const best = far.indexOf(Math.min(...far));
      return far[best] < 30 * devicePixelRatio ? best : -1;
    };
    return {
      down: (x, y) => { held = near(x, y); if (held >= 0) this.corner = held; },
      move: (x, y) => {
        if (held < 0) return false;
        this.places[held] = this.sheet.fromScreen(x, y);
        this.magnified = [x, y];
        this.sheet.ask();
        return true;
      },
      up: () => { held = -1; this.magnified = null; this.sheet.ask(); },
    };
  }

  // Enter does at the middle of the view what a click does there; a drag begins and ends with it.
  enter() {
    const { canvas, tool } = this.sheet, middle = [canvas.width / 2, canvas.height / 2];
    if (!tool.down || this.name === "corners") tool.click?.(...middle);
    else if (!this.armed) {
      tool.down(...middle);
      this.armed = true;
    } else {
      this.armed = false;
      tool.move(...middle);
      tool.up(...middle);
    }
    this.sheet.ask();
  }

  // The cross in the middle, for those who use the keys.
  drawCross(context) {
    const { canvas } = this.sheet, r = 14 * devicePixelRatio;
    if (document.activeElement !== canvas || !canvas.matches(":focus-visible")) return;
    const [x, y] = [canvas.width / 2, canvas.height / 2];
    if (this.armed) this.sheet.tool.move(x, y);
    this.magnified = null;
    context.strokeStyle = getComputedStyle(canvas).getPropertyValue("--focus");
    context.lineWidth = 1.4 * devicePixelRatio;
    context.beginPath();
    context.moveTo(x - r, y); context.lineTo(x + r, y);
    context.moveTo(x, y - r); context.lineTo(x, y + r);
    context.stroke();
  }

  // Keys 1 to 4 choose a corner, arrows move it by a pixel, with Shift by twenty.
  key(event) {
    if (event.key === "Enter") { this.enter(); return true; }
    if (this.name !== "corners") return false;
    if ("1234".includes(event.key)) { this.corner = Number(event.key) - 1; this.sheet.ask(); return true; }
    const step = event.shiftKey ? 20 : 1;
    const moves = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step] }[event.key];
    if (!moves) return false;
    const place = this.places[this.corner];
    place[0] += moves[0];
    place[1] += moves[1];
    this.sheet.ask();
    return true;
  }

  draw(context) {
    this.drawCross(context);
    if (!this.places.length) return;
    const { sheet } = this, ratio = devicePixelRatio, at = this.places.map((p) => sheet.toScreen(p));
    const colour = getComputedStyle(sheet.canvas).getPropertyValue("--head");
    context.strokeStyle = context.fillStyle = colour;
    context.lineWidth = 1.6 * ratio;
    context.beginPath();
    at.forEach(([x, y], i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
    if (this.name === "corners") context.closePath();
    context.stroke();
    at.forEach(([x, y], i) => {
      context.beginPath();
      context.arc(x, y, (this.name === "corners" && i === this.corner ? 9 : 6) * ratio, 0, 7);
      context.stroke();
      if (this.name === "corners") { context.font = `${12 * ratio}px system-ui`; context.fillText(String(i + 1), x + 12 * ratio, y - 8 * ratio); }
    });
    if (this.name === "arrow" && at.length === 2) drawArrow(context, ...at, colour);
    if (this.magnified) this.magnify(context, ...this.magnified);
  }

  magnify(context, x, y) {
    const { sheet } = this, ratio = devicePixelRatio, r = 62 * ratio;
    const [cx, cy] = [x, y > 3 * r ? y - 1.6 * r : y + 1.6 * r];
    const px = sheet.fromScreen(x, y), scale = sheet.view.scale * MAGNIFIED;
    context.save();
    context.beginPath();
    context.arc(cx, cy, r, 0, 7);
    context.fillStyle = "#fff";
    context.fill();
    context.clip();
    context.translate(cx - r, cy - r);
    sheet.drawTiles(context, { x: px[0] - r / scale, y: px[1] - r / scale, scale }, 2 * r, 2 * r);
    context.beginPath();
    context.moveTo(r - 12 * ratio, r); context.lineTo(r + 12 * ratio, r);
    context.moveTo(r, r - 12 * ratio); context.lineTo(r, r + 12 * ratio);
    context.stroke();
    context.restore();
    context.beginPath();
    context.arc(cx, cy, r, 0, 7);
    context.stroke();
  }
}

// The small form over the sheet that asks for one text.
export class Ask {
  constructor() {
    this.form = document.getElementById("ask");
    this.input = document.getElementById("ask-text");
    this.refused = document.getElementById("ask-refused");
    this.form.addEventListener("submit", async (event) => {
      event.preventDefault();
      const why = await this.answer?.(this.input.value.trim());
      this.refused.textContent = why ?? "";
      if (!why) this.end();
    });
    document.getElementById("ask-cancel").addEventListener("click", () => this.end());
    this.form.addEventListener("keydown", (event) => { if (event.key === "Escape") { event.stopPropagation(); this.end(); } });
  }

  open(label, example, answer, after) {
    Object.assign(this, { answer, after });
    document.getElementById("ask-label").textContent = label;
    this.input.placeholder = example;
    this.input.value = "";
    this.refused.textContent = "";
    this.form.hidden = false;
    this.input.focus({ preventScroll: true });
  }

  close() {
    this.form.hidden = true;
    this.answer = null;
  }

  end() {
    this.close();
    this.after?.();
  }
}
