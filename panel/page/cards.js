// The cards of the operator's column: lines, result, files, notes.

import { element, length, place } from "./format.js";
import { handle, inOrder, orderOf } from "./orders.js";
import { figureRows, worstRows } from "./result.js";
import { colourOf } from "./tiles.js";

const WHICH = [["", "Longest"], ["contours", "Contours"], ["all", "All ink"]];
const SAVES = [["program", "Program for the machine"], [".wav", "Tape"], [".ngc", "G-code"], [".dxf", "DXF"], [".svg", "SVG"], [".csv", "Path"], [".html", "Page"]];

export function chosenNumbers(options) {
  const text = options["--lines"] ?? "";
  return /^[\d,\s]+$/.test(text) ? text.split(",").map(Number) : [];
}

// The lines that are followed: those of --lines, else what the cutter or the machine is for.
function linesOf(state) {
  return state.options["--lines"] ?? state.usual_lines ?? "";
}

// Whether a line is among those that are followed.
export function isChosen(state, number) {
  const options = state.options, numbers = chosenNumbers(options), which = linesOf(state);
  if (numbers.length) return numbers.includes(number);
  const line = state.sheet?.figures.lines.find((row) => row.line === number);
  if (which === "all") return true;
  if (which === "contours") return line?.in_contours ?? false;
  if (which === "outer") return (line?.in_contours && line.inside === null) ?? false;
  return options["--start"] || options["--arrow"] ? true : number === 1;
}

export function toggled(options, number) {
  const numbers = chosenNumbers(options);
  const next = numbers.includes(number) ? numbers.filter((n) => n !== number) : [...numbers, number];
  return next.length ? next.sort((a, b) => a - b).join(",") : null;
}

export function showWhich(host, state, set) {
  const options = state.options, longest = state.usual_lines ? "1" : "", which = linesOf(state);
  const now = options["--start"] || (options["--arrow"] && !which) ? "start" : (which === longest ? "" : which);
  host.replaceChildren(...WHICH.map(([value, text]) =>
    element("button", { "aria-pressed": String(now === value), onclick: () => set({ "--lines": value || longest || null, "--start": null, "--order": null, ...(value === "contours" ? {} : { "--arrow": null }) }) }, text)));
}

// What is set when a line is chosen or left out: it has no place in the order then.
export function choosing(options, number) {
  const lines = toggled(options, number), left = (lines ?? "").split(",").map(Number);
  const order = orderOf(options).filter((n) => left.includes(n));
  return { "--lines": lines, "--start": null, "--order": order.length > 1 ? order.join(",") : null };
}

export function showLines(host, state, set, under) {
  if (host.dataset.dragging) return;
  const lines = inOrder(state.options, state.sheet?.figures.lines ?? []);
  const { line: focused, handle: held } = document.activeElement?.dataset ?? {};
  const chosen = linesOf(state) === "all" ? [] : lines.filter((row) => isChosen(state, row.line)).map((row) => row.line);
  document.getElementById("lines-count").textContent = lines.length ? `${chosen.length || lines.length} of ${lines.length}` : "";
  const place = (numbers) => set({ "--order": numbers.join(",") });
  host.replaceChildren(...lines.map((row) => {
    const checked = isChosen(state, row.line);
    const box = element("input", {
      type: "checkbox", checked, "data-line": row.line,
      onchange: () => set(choosing(state.options, row.line)),
    });
    box.checked = checked;
    const swatch = element("span", { class: "swatch", "aria-hidden": "true" });
    swatch.style.color = colourOf(row.line);
    const what = [row.kind, row.kind === "dot" ? null : length(row.length_mm), row.remark, row.inside ? `in ${row.inside}` : null].filter(Boolean).join(", ");
    return element("li", { onpointerenter: () => under(row.line), onpointerleave: () => under(0), "data-row": row.line },
      element("label", {}, box, swatch, element("span", { class: "no" }, String(row.line)), element("span", { class: "what", title: what }, what)),
      chosen.length > 1 && chosen.includes(row.line) ? handle(row.line, chosen, place) : null);
  }));
  if (held) host.querySelector(`[data-handle="${held}"]`)?.focus();
  if (focused) host.querySelector(`[data-line="${focused}"]`)?.focus();
}

export function lineText(state, number) {
  const row = state.sheet?.figures.lines.find((line) => line.line === number);
  if (!row) return "";
  const parts = [`line ${number}`, row.kind, row.kind === "dot" ? null : length(row.length_mm), row.line_width_mm ? `${length(row.line_width_mm)} wide` : null];
  return parts.filter(Boolean).join(" · ");
}

export function showResult(result, goTo) {
  document.getElementById("figures").replaceChildren(...figureRows(result).flatMap(([name, value]) => [element("dt", {}, name), element("dd", {}, value)]));
  document.getElementById("worst").replaceChildren(...worstRows(result, goTo));
  document.getElementById("all-figures").textContent = JSON.stringify(result.figures, null, 1);
}

export function showSaves(host, state, save) {
  const can = ([kind]) => kind === ".html" || kind in state.commands;
  const list = SAVES.filter(can).filter(([kind]) => kind !== "program" || state.options["--machine"]).filter(([kind]) => kind !== ".ngc" || !state.options["--machine"]);
  host.replaceChildren(...list.map(([kind, text]) => element("button", { "data-save": kind, onclick: () => save(kind), disabled: state.busy !== null && state.busy.kind !== "lines" }, text)));
}

export function showFiles(host, files) {
  const shown = host.dataset.shown, now = files.join("/");
  if (shown === now) return;
  host.dataset.shown = now;
  host.replaceChildren(...files.map((name) => element("li", {}, element("a", { href: `/file/${encodeURIComponent(name)}`, download: name }, name))));
}

export function showMessages(host, messages, goTo) {
  const now = JSON.stringify(messages);
  if (host.dataset.shown === now) return;
  host.dataset.shown = now;
  host.replaceChildren(...messages.map((message) => element("li", { class: message.kind }, message.text,
    message.place_mm ? element("button", { class: "plain", onclick: () => goTo({ x_mm: message.place_mm[0], y_mm: message.place_mm[1] }) }, "Show") : null)));
}

// The corrections of the drawing, each with a button that takes it away.
export function showCorrections(host, state, goTo, remove) {
  const corrections = state.sheet?.corrections ?? [];
  host.parentElement.hidden = !corrections.length;
  host.replaceChildren(...corrections.map((one) => element("li", {},
    element("button", { class: "plain", onclick: () => goTo({ x_mm: one.place_mm[0], y_mm: one.place_mm[1] }) }, `${one.number}  ${one.do} at ${place(...one.place_mm)}`),
    element("button", { class: "plain", "aria-label": `Take correction ${one.number} away`, onclick: () => remove(one.number) }, "✕"))));
}
