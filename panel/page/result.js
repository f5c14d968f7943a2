// A result on the sheet: the played contour in the colours of its error, the machine's place at a time, marks.

import { element, length, place, time } from "./format.js";

export const RAMP = ["#2b6ca3", "#3a8fa0", "#5aa56b", "#b3a52e", "#d98323", "#cf5027", "#ad1f2d"];

const PIECE = 400; // rows of a piece: what is out of sight is not drawn
const STEPS = [1, 4, 16, 64]; // every so many rows, from near to far

// The error in seven colours, in pieces, each at several steps as Path2Ds of mm, made when they are first drawn.
export function errorPaths(error, largest) {
  const { x_mm: x, y_mm: y } = error, pieces = [];
  for (let first = 0; first < x.length - 1; first += PIECE) {
    const last = Math.min(first + PIECE, x.length - 1), box = [Infinity, Infinity, -Infinity, -Infinity];
    for (let i = first; i <= last; i++) {
      box[0] = Math.min(box[0], x[i]); box[1] = Math.min(box[1], y[i]);
      box[2] = Math.max(box[2], x[i]); box[3] = Math.max(box[3], y[i]);
    }
    pieces.push({ first, last, box, paths: new Map() });
  }
  let way = 0;
  for (let i = 1; i < x.length; i++) way += Math.min(1.5, Math.hypot(x[i] - x[i - 1], y[i] - y[i - 1]));
  return { error, largest, pieces, apart: way / Math.max(1, x.length - 1) };
}

// One piece in the seven colours; over several rows the largest error counts.
function inColours({ error, largest }, { first, last }, step) {
  const paths = RAMP.map(() => new Path2D()), { x_mm: x, y_mm: y, error_mm: e } = error;
  for (let from = first; from < last; from += step) {
    const to = Math.min(from + step, last);
    let most = null;
    for (let i = from + 1; i <= to; i++) {
      if (Math.hypot(x[i] - x[i - 1], y[i] - y[i - 1]) > 1.5) most = NaN;
      else if (e[i] !== null) most = Math.max(most ?? 0, e[i]);
    }
    if (most === null || Number.isNaN(most)) continue;
    const path = paths[Math.min(RAMP.length - 1, Math.floor((RAMP.length * most) / largest))];
    path.moveTo(x[from], y[from]);
    path.lineTo(x[to], y[to]);
  }
  return paths;
}

// The largest error that the colours tell apart: 98 of 100 places are below it.
export function errorScale(error) {
  const known = error.error_mm.filter((e) => e !== null).sort((a, b) => a - b);
  return known[Math.floor(0.98 * (known.length - 1))] || 1e-3;
}

// `unit`: mm to a pixel of the screen; `seen`: what of the sheet is painted, mm, [left, bottom, right, top].
export function drawErrors(context, errors, unit, seen) {
  const step = STEPS.findLast((s) => s * errors.apart < Math.max(unit, errors.apart)) ?? 1;
  context.lineWidth = 3 * unit;
  context.lineCap = "round";
  const margin = 3 * unit;
  const near = errors.pieces.filter(({ box }) => !seen || (box[0] - margin < seen[2] && box[2] + margin > seen[0] && box[1] - margin < seen[3] && box[3] + margin > seen[1]));
  RAMP.forEach((colour, i) => {
    context.strokeStyle = colour;
    for (const piece of near) {
      if (!piece.paths.has(step)) piece.paths.set(step, inColours(errors, piece, step));
      context.stroke(piece.paths.get(step)[i]);
    }
  });
}

// The machine at a time: the row before it, and its place between that row and the next.
export function machineAt(path, t) {
  const times = path.t_s;
  let low = 0, high = times.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle;
    else high = middle;
  }
  const share = Math.min(1, Math.max(0, (t - times[low]) / (times[high] - times[low] || 1)));
  const at = (column) => path[column][low] + share * (path[column][high] - path[column][low]);
  const way = Math.hypot(path.x_mm[high] - path.x_mm[low], path.y_mm[high] - path.y_mm[low]);
  return { row: low, x: at("x_mm"), y: at("y_mm"), z: at("z_mm"), feed: way / (times[high] - times[low] || 1), down: path.tool[low] === 1 };
}

// The way up to a row, where the tool is in the work; drawn in mm.
export function drawMachine(context, path, now, unit, colours) {
  context.lineWidth = 1.6 * unit;
  context.strokeStyle = colours.way;
  context.beginPath();
  for (let i = Math.max(0, now.row - 4000); i <= now.row; i++) {
    if (i === 0 || !path.tool[i]) context.moveTo(path.x_mm[i], path.y_mm[i]);
    else context.lineTo(path.x_mm[i], path.y_mm[i]);
  }
  context.lineTo(now.x, now.y);
  context.stroke();
  context.beginPath();
  context.arc(now.x, now.y, 7 * unit, 0, 7);
  context.fillStyle = now.down ? colours.down : colours.up;
  context.globalAlpha = 0.9;
  context.fill();
  context.globalAlpha = 1;
  context.strokeStyle = "#fff";
  context.lineWidth = 2 * unit;
  context.stroke();
}

// Worst places and other marks as rings with numbers.
export function drawWorst(context, worst, unit, colour) {
  context.strokeStyle = colour;
  context.lineWidth = 1.6 * unit;
  for (const place of worst) {
    context.beginPath();
    context.arc(place.x_mm, place.y_mm, 9 * unit, 0, 7);
    context.stroke();
  }
}

// What the colours mean.
export function showLegend(host, scale) {
  const ramp = RAMP.map((colour) => { const cell = element("i"); cell.style.background = colour; return cell; });
  host.replaceChildren("distance from the ink's middle", element("div", { class: "ramp", "aria-hidden": "true" }, ...ramp),
    element("div", { class: "ends" }, element("span", {}, "0"), element("span", {}, `${length(scale)} and more`)));
}

// The figures that say how good a run is, as pairs of name and text.
export function figureRows(result) {
  const figures = result.figures, ink = figures.played_to_ink ?? {}, traced = figures.traced_to_ink ?? {};
  return [
    ["Length", length(figures.length_mm)],
    ["Time on the machine", time(result.played.t_s.at(-1) - result.played.t_s[0])],
    ["Ending", figures.ending + (figures.incomplete ? ", incomplete" : "")],
    ["Machine off the ink, RMS", length(ink.rms_mm)],
    ["at most", length(ink.max_mm)],
    ["Head off the ink, RMS", length(traced.rms_mm)],
    ["Ink not covered", length(figures.missed_ink_mm)],
  ];
}

// The worst places as rows of a list, each a button that goes there.
export function worstRows(result, goTo) {
  return result.worst.map((worst, i) =>
    element("li", {}, element("button", { onclick: () => goTo(worst) }, `${i + 1}.  at ${place(worst.x_mm, worst.y_mm)}`, element("b", {}, length(worst.error_mm)))));
}
