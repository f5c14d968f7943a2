// The keepsake: a result that opens without a server. The picture is in the file; the rest is the panel's own.

import { element } from "./format.js";
import { Replay } from "./replay.js";
import { drawErrors, drawMachine, drawWorst, errorPaths, errorScale, figureRows, showLegend, worstRows } from "./result.js";
import { Sheet } from "./sheet.js";

class Still extends Sheet {
  drawTiles(context, view) {
    if (!this.image) return;
    const { columns, rows } = this.picture;
    context.drawImage(this.image, -view.x * view.scale, -view.y * view.scale, columns * view.scale, rows * view.scale);
  }
}

const data = JSON.parse(document.getElementById("data").textContent), { result, picture } = data;
const root = document.documentElement, by = (id) => document.getElementById(id);
root.dataset.theme = matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
const still = new Still(by("sheet"), 512);
let machine = null;
const scale = errorScale(result.error), paths = errorPaths(result.error, scale);
still.ground.layers.push((context) => {
  const perMm = still.view.scale / still.pitch, unit = devicePixelRatio / perMm;
  context.setTransform(perMm, 0, 0, -perMm, ...still.toScreen(still.toPx([0, 0])));
  const hot = getComputedStyle(still.canvas).getPropertyValue("--head");
  drawErrors(context, paths, unit);
  drawWorst(context, result.worst, unit, hot);
});
still.layers.push((context) => {
  const perMm = still.view.scale / still.pitch, unit = devicePixelRatio / perMm;
  context.setTransform(perMm, 0, 0, -perMm, ...still.toScreen(still.toPx([0, 0])));
  const hot = getComputedStyle(still.canvas).getPropertyValue("--head");
  if (machine) drawMachine(context, result.played, machine, unit, { way: "#20211f", down: hot, up: "#4a7fae" });
});
still.image = new Image();
still.image.onload = () => still.renew();
still.image.src = picture.address;
still.resize();
still.show({ id: 1, rows: picture.rows, columns: picture.columns, levels: 1, has_lines: false }, picture.mm_per_px);
const onTime = (now) => { machine = now; still.ask(); };
let again = new Replay(by("machine"), result, onTime);

by("theme").addEventListener("click", () => {
  root.dataset.theme = root.dataset.theme === "dark" ? "light" : "dark";
  again.close();
  still.renew();
  again = new Replay(by("machine"), result, onTime);
});
by("figures").replaceChildren(...figureRows(result).flatMap(([name, value]) => [element("dt", {}, name), element("dd", {}, value)]));
by("worst").replaceChildren(...worstRows(result, (worst) => still.goTo([worst.x_mm, worst.y_mm], 24)));
by("messages").replaceChildren(...(result.faults.length ? result.faults : ["nothing went wrong"]).map((text) => element("li", {}, text)));
by("all-figures").textContent = JSON.stringify(result.figures, null, 1);
by("command").textContent = data.command;
showLegend(by("legend"), scale);
root.dataset.ready = "true";
