// Layers over the sheet: the numbers of the lines, the start, the corrections.

import { colourOf } from "./tiles.js";

const MOST_NUMBERS = 80; // more would hide the sheet
const HIGH = 16; // of a name's box, screen px

export function drawNumbers(context, sheet, state) {
  const lines = state?.sheet?.figures.lines ?? [];
  if (!sheet.pitch || lines.length > MOST_NUMBERS) return;
  const ratio = devicePixelRatio;
  context.font = `600 ${11 * ratio}px system-ui, sans-serif`;
  context.textAlign = "center";
  context.textBaseline = "middle";
  const taken = [];
  for (const line of lines) {
    const [x, y] = sheet.toScreen(sheet.toPx(line.place_mm));
    const at = besideOthers(context, taken, x + 13 * ratio, y - 13 * ratio, -ratio, String(line.line));
    leader(context, x, y, at, colourOf(line.line), ratio);
    tag(context, ...at, String(line.line), colourOf(line.line), ratio);
  }
}

export function drawCorrections(context, sheet, state) {
  const corrections = state?.sheet?.corrections ?? [];
  const ratio = devicePixelRatio, colour = "#7a3fa0";
  context.font = `600 ${11 * ratio}px system-ui, sans-serif`;
  context.textAlign = "center";
  context.textBaseline = "middle";
  for (const one of corrections) {
    const [x, y] = sheet.toScreen(sheet.toPx(one.place_mm));
    context.strokeStyle = colour;
    context.lineWidth = 1.6 * ratio;
    context.setLineDash([3 * ratio, 3 * ratio]);
    context.beginPath();
    context.arc(x, y, 11 * ratio, 0, 7);
    context.stroke();
    context.setLineDash([]);
    tag(context, x, y - 22 * ratio, one.do, colour, ratio);
  }
}

// What a run has to say of places: stops, tabs, what was left out, and where the line was lost.
export function drawMarks(context, sheet, result) {
  if (!result || !sheet.pitch) return;
  const ratio = devicePixelRatio, lost = result.fault_place_mm;
  context.font = `${11 * ratio}px system-ui, sans-serif`;
  context.textAlign = "center";
  context.textBaseline = "middle";
  const taken = [];
  for (const [name, place] of Object.entries(result.marks_mm)) {
    const [x, y] = sheet.toScreen(sheet.toPx(place));
    const at = besideOthers(context, taken, x, y + 16 * ratio, ratio, name);
    leader(context, x, y, at, "#4a5560", ratio);
    tag(context, ...at, name, "#4a5560", ratio);
  }
  if (!lost) return;
  const [x, y] = sheet.toScreen(sheet.toPx(lost)), r = 8 * ratio;
  context.strokeStyle = "#ad1f2d";
  context.lineWidth = 3 * ratio;
  context.beginPath();
  context.moveTo(x - r, y - r); context.lineTo(x + r, y + r);
  context.moveTo(x - r, y + r); context.lineTo(x + r, y - r);
  context.stroke();
  tag(context, x, y - 20 * ratio, "lost here", "#ad1f2d", ratio);
}

export function drawStart(context, sheet, state) {
  const start = state?.options["--start"];
  if (!start || !sheet.pitch) return;
  const [x, y] = sheet.toScreen(sheet.toPx(start.split(",").map(parseFloat))), r = 9 * devicePixelRatio;
  context.strokeStyle = getComputedStyle(sheet.canvas).getPropertyValue("--head");
  context.lineWidth = 2 * devicePixelRatio;
  context.beginPath();
  context.arc(x, y, r, 0, 7);
  context.moveTo(x - 1.6 * r, y);
  context.lineTo(x + 1.6 * r, y);
  context.moveTo(x, y - 1.6 * r);
  context.lineTo(x, y + 1.6 * r);
  context.stroke();
}

// The place for a name nearest to its own, up (negative) or down, at which it hides none of those that are there.
export function besideOthers(context, taken, x, y, towards, text) {
  const ratio = Math.abs(towards), width = widthOf(context, text, ratio), high = HIGH * ratio;
  const hides = (other) => Math.abs(other.x - x) < (other.width + width) / 2 && Math.abs(other.y - y) < high;
  while (taken.some(hides)) y += (HIGH + 1) * towards;
  taken.push({ x, y, width });
  return [x, y];
}

// A thin line from a place to its name, where that stands further off than its own height.
function leader(context, x, y, [toX, toY], colour, ratio) {
  if (Math.hypot(toX - x, toY - y) < 2 * HIGH * ratio) return;
  context.strokeStyle = colour;
  context.lineWidth = ratio;
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(toX, toY);
  context.stroke();
}

const widthOf = (context, text, ratio) => context.measureText(text).width + 9 * ratio;

function tag(context, x, y, text, colour, ratio) {
  const width = widthOf(context, text, ratio), height = HIGH * ratio;
  context.fillStyle = "rgba(255, 255, 255, 0.9)";
  context.strokeStyle = colour;
  context.lineWidth = ratio;
  context.beginPath();
  context.roundRect(x - width / 2, y - height / 2, width, height, 5 * ratio);
  context.fill();
  context.stroke();
  context.fillStyle = colour;
  context.fillText(text, x, y + 0.5 * ratio);
}
