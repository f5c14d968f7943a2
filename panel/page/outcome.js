// The result of the last run on the page: the error's colours and the worst places on the sheet, the figures, the machine.

import { showResult } from "./cards.js";
import { drawMarks } from "./layers.js";
import { Replay } from "./replay.js";
import { drawErrors, drawMachine, drawWorst, errorPaths, errorScale, showLegend } from "./result.js";

const by = (id) => document.getElementById(id);

// None where another run has begun since; a server that ends in the middle throws.
async function lastResult() {
  const answer = await fetch("/result");
  return answer.status === 200 ? answer.json() : null;
}

export class Outcome {
  // onNew() hears that there is another result, onOverride(share) that the machine is to run at another feed
  constructor(sheet, goTo, onNew, onOverride) {
    Object.assign(this, { sheet, goTo, onNew, onOverride });
    this.result = null;
    this.shown = "";
    this.replay = null;
    this.now = null;
    this.hidden = false; // while a run is under way
    sheet.ground.layers.push((context, _, rect) => this.drawStill(context, rect));
    sheet.layers.push((context) => this.drawMoving(context));
  }

  async take(state) {
    const running = state.busy?.kind === "run";
    const now = JSON.stringify(state.result ?? null) + state.files.join() + running;
    by("stale").hidden = !state.result || state.result.is_of_now;
    if (now === this.shown) return;
    this.shown = now;
    const taken = state.result ? await lastResult().catch(() => null) : null;
    if (now !== this.shown) return;
    const before = this.taken, same = taken && this.result && JSON.stringify([taken.figures, taken.override]) === JSON.stringify([this.result.figures, this.result.override]);
    const ranAgain = taken && this.result && taken.override !== this.result.override;
    this.taken = true;
    const share = ranAgain ? this.replay?.share : 0;
    this.result = taken;
    by("result-card").hidden = by("machine").hidden = by("legend").hidden = !taken;
    this.onNew();
    if (same) return;
    this.show(share);
    if (taken && state.busy === null && before && !ranAgain) by("result-card").scrollIntoView({ block: "start", behavior: "smooth" });
  }

  // Lay the result on the page; the machine stands so far along its program.
  show(share = 0) {
    this.replay?.close();
    this.replay = null;
    this.now = null;
    const { result } = this;
    if (result) {
      const largest = errorScale(result.error);
      this.errors = errorPaths(result.error, largest);
      showResult(result, this.goTo);
      showLegend(by("legend"), largest);
      this.replay = new Replay(by("machine"), result, (now) => { this.now = now; this.sheet.ask(); }, this.onOverride, share);
    }
    this.sheet.renew();
  }

  get seen() {
    return Boolean(this.result && this.errors && this.sheet.pitch && !this.hidden);
  }

  // mm of the sheet to the screen; returns mm to a pixel of the screen
  inMm(context) {
    const { sheet } = this, perMm = sheet.view.scale / sheet.pitch;
    context.setTransform(perMm, 0, 0, -perMm, ...sheet.toScreen(sheet.toPx([0, 0])));
    return devicePixelRatio / perMm;
  }

  drawStill(context, [left, top, right, bottom]) {
    const { sheet } = this;
    if (!this.seen) return;
    const [a, b] = [[left, bottom], [right, top]].map((at) => sheet.toMm(sheet.fromScreen(...at)));
    context.save();
    const unit = this.inMm(context);
    drawErrors(context, this.errors, unit, [...a, ...b]);
    drawWorst(context, this.result.worst, unit, getComputedStyle(sheet.canvas).getPropertyValue("--head"));
    context.restore();
    drawMarks(context, sheet, this.result);
  }

  drawMoving(context) {
    if (!this.seen || !this.now) return;
    const style = getComputedStyle(this.sheet.canvas);
    drawMachine(context, this.result.played, this.now, this.inMm(context), { way: "#20211f", down: style.getPropertyValue("--head"), up: "#4a7fae" });
  }
}
