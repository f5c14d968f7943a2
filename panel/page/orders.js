// The order of the lines, and the arrows on them: what the operator drags becomes --order and --arrow.

import { element } from "./format.js";

// The lines in the order in which they are listed: those of --order first.
export function inOrder(options, lines) {
  const told = orderOf(options), rank = (line) => (told.includes(line.line) ? told.indexOf(line.line) : told.length + line.line);
  return [...lines].sort((a, b) => rank(a) - rank(b));
}

export function orderOf(options) {
  return (options["--order"] ?? "").split(",").filter(Boolean).map(Number);
}

// The numbers with one of them at another place among them.
export function moved(numbers, number, to) {
  const rest = numbers.filter((n) => n !== number), at = Math.max(0, Math.min(rest.length, to));
  return [...rest.slice(0, at), number, ...rest.slice(at)];
}

// A handle by which a line is dragged in the list, or moved with the arrow keys; `numbers` are those that have an order.
export function handle(number, numbers, place) {
  const at = numbers.indexOf(number);
  const made = element("button", { class: "handle plain", "data-handle": number, title: "Drag, or press up or down: the order of cutting",
    "aria-label": `Line ${number}, cut ${at + 1} of ${numbers.length}; up and down keys move it` }, "⠿");
  made.addEventListener("keydown", (event) => {
    const by = { ArrowUp: -1, ArrowDown: 1 }[event.key];
    if (!by) return;
    event.preventDefault();
    if (at + by >= 0 && at + by < numbers.length) place(moved(numbers, number, at + by));
  });
  made.addEventListener("pointerdown", (event) => drag(event, made.closest("li"), () => {
    const rows = [...made.closest("ul").children].map((row) => Number(row.dataset.row)).filter((n) => numbers.includes(n));
    if (rows.join() !== numbers.join()) place(rows);
  }));
  return made;
}

// The row goes where the pointer is; the window hears it, because a row that is moved in the list loses the pointer.
function drag(event, row, done) {
  const list = row.parentElement, held = new AbortController(), { signal } = held;
  event.preventDefault();
  event.currentTarget.focus();
  row.classList.add("dragged");
  list.dataset.dragging = "true";
  const others = () => [...list.children].filter((other) => other !== row && other.querySelector(".handle"));
  const move = (now) => {
    const before = others().find((other) => now.clientY < middle(other));
    if (before) before.before(row);
    else others().at(-1)?.after(row);
  };
  const up = () => {
    held.abort();
    row.classList.remove("dragged");
    delete list.dataset.dragging;
    done();
  };
  addEventListener("pointermove", move, { signal });
  addEventListener("pointerup", up, { signal });
  addEventListener("pointercancel", up, { signal });
}

function middle(row) {
  const box = row.getBoundingClientRect();
  return box.top + box.height / 2;
}

// The arrows: [[x, y], [towards x, towards y]] in mm.
export function arrowsOf(options) {
  return (options["--arrow"] ?? "").split(";").filter(Boolean).map((one) => one.trim().split(/\s+/).map((place) => place.split(",").map(parseFloat)));
}

export function arrowText(arrows) {
  return arrows.map((one) => one.map((place) => place.map((v) => v.toFixed(2)).join(",")).join(" ")).join("; ") || null;
}

// The arrows with one more; another that begins within `near` mm of it makes room.
export function withArrow(options, arrow, near) {
  const others = arrowsOf(options).filter(([from]) => Math.hypot(from[0] - arrow[0][0], from[1] - arrow[0][1]) > near);
  return [...others, arrow];
}

export function drawArrows(context, sheet, options) {
  if (!sheet.pitch) return;
  for (const [from, to] of arrowsOf(options)) drawArrow(context, sheet.toScreen(sheet.toPx(from)), sheet.toScreen(sheet.toPx(to)), getComputedStyle(sheet.canvas).getPropertyValue("--head"));
}

// An arrow on the screen, always as long.
export function drawArrow(context, from, to, colour) {
  const ratio = devicePixelRatio, heading = Math.atan2(to[1] - from[1], to[0] - from[0]), long = 38 * ratio, head = 9 * ratio;
  const tip = [from[0] + long * Math.cos(heading), from[1] + long * Math.sin(heading)];
  for (const [width, ink] of [[6, "rgba(255, 255, 255, 0.9)"], [2.6, colour]]) {
    context.strokeStyle = context.fillStyle = ink;
    context.lineWidth = width * ratio;
    context.lineCap = context.lineJoin = "round";
    context.beginPath();
    context.moveTo(...from);
    context.lineTo(...tip);
    for (const side of [-0.5, 0.5]) {
      context.moveTo(...tip);
      context.lineTo(tip[0] - head * Math.cos(heading + side), tip[1] - head * Math.sin(heading + side));
    }
    context.stroke();
    context.beginPath();
    context.arc(...from, (width > 3 ? 6 : 4.4) * ratio, 0, 7);
    context.fill();
  }
}

export function showArrows(host, options, goTo, set) {
  const arrows = arrowsOf(options);
  host.parentElement.hidden = !arrows.length;
  host.replaceChildren(...arrows.map(([from], i) => element("li", {},
    element("button", { class: "plain", onclick: () => goTo({ x_mm: from[0], y_mm: from[1] }) }, `begins at ${from.map((v) => v.toFixed(1)).join(", ")}`),
    element("button", { class: "plain", "aria-label": `Take arrow ${i + 1} away`, onclick: () => set({ "--arrow": arrowText(arrows.filter((_, k) => k !== i)) }) }, "✕"))));
}
