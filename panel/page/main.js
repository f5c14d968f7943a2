// The panel: what the server says is shown, what the operator does is sent. It decides nothing of its own.

import { isChosen, lineText, showCorrections, showFiles, showLines, showMessages, showResult, showSaves, showWhich, toggled } from "./cards.js";
import { Fields } from "./fields.js";
import { element } from "./format.js";
import { Head } from "./head.js";
import { drawCorrections, drawMarks, drawNumbers, drawStart } from "./layers.js";
import { Link } from "./link.js";
import { Replay } from "./replay.js";
import { drawErrors, drawMachine, drawWorst, errorPaths, errorScale, showLegend } from "./result.js";
import { Sheet } from "./sheet.js";
import { Ask, Tools } from "./tools.js";

const PACES = [[null, "fast"], [10, "10 ×"], [2, "200 %"], [1, "100 %"], [0.5, "50 %"], [0.1, "10 %"]];
const SCALE = ["--width", "--dpi"], MAIN = ["--machine", "--cutter", "--side", "--depth"];
const by = (id) => document.getElementById(id);

const link = new Link(onFrame, (is) => { by("connection").textContent = is ? "" : "no connection"; });
const fields = new Fields(link);
let sheet, head, tools, replay, state = null, result = null, shownResult = "";

begin();

async function begin() {
  theme(localStorage.getItem("theme") ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light"));
  const first = await link.begin().catch((error) => say(error.message));
  if (!first) return;
  sheet = new Sheet(by("sheet"), first.tile);
  head = new Head(sheet, by("inset"), by("inset-canvas"));
  tools = new Tools(sheet, link, new Ask(), say);
  tools.onChoose = (number) => number && set({ "--lines": toggled(state.options, number), "--start": null });
  tools.onRefused = say;
  const calm = () => !result && !(state?.busy && state.busy.kind !== "lines");
  sheet.layers.push(drawResult, (c) => !head.busy && drawMarks(c, sheet, result), (c) => drawStart(c, sheet, state), (c) => drawCorrections(c, sheet, state), (c) => calm() && drawNumbers(c, sheet, state));
  sheet.onHover = hover;
  placeFields(first.fields);
  wire();
  onFrame({ state: first.state });
  document.documentElement.dataset.ready = "true";
}

function placeFields(every) {
  const take = (names) => every.filter((field) => names.includes(field.option));
  const group = (name, but) => every.filter((field) => field.group === name && !but.includes(field.option));
  fields.place(by("fields-scale"), take(SCALE));
  fields.place(by("fields-drawing"), group("Drawing", SCALE));
  fields.place(by("fields-line"), group("Line", []));
  fields.place(by("fields-main"), take(MAIN));
  fields.place(by("fields-machine"), group("Machine", MAIN));
  fields.place(by("fields-cutting"), [...group("Tool", MAIN), ...group("Cutting", [])]);
  fields.place(by("fields-rest"), [...group("Head", []), ...group("Placement", [])]);
  by("pace").append(...PACES.map(([times, text]) => element("option", { value: times ?? "" }, text)));
}

function wire() {
  const act = (id, action) => by(id).addEventListener("click", async () => { const why = await link.do(action()); if (why) say(why); });
  act("run-button", () => ({ do: "run" }));
  act("hold", () => ({ do: state.busy?.held ? "resume" : "hold" }));
  act("step", () => ({ do: "step" }));
  act("stop", () => ({ do: "stop" }));
  act("undo", () => ({ do: "undo" }));
  act("redo", () => ({ do: "redo" }));
  by("pace").addEventListener("change", () => link.do({ do: "pace", times: by("pace").value ? Number(by("pace").value) : null }));
  by("sources").addEventListener("change", () => open(by("sources").value));
  by("upload").addEventListener("change", () => upload(by("upload").files[0]));
  by("theme").addEventListener("click", () => theme(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));
  by("zoom-in").addEventListener("click", () => sheet.zoom(1.5));
  by("zoom-out").addEventListener("click", () => sheet.zoom(1 / 1.5));
  by("zoom-all").addEventListener("click", () => sheet.all());
  by("command-kind").addEventListener("change", showCommand);
  by("copy").addEventListener("click", copy);
  const bench = by("bench");
  bench.addEventListener("dragover", (event) => { event.preventDefault(); bench.classList.add("drop"); });
  bench.addEventListener("dragleave", () => bench.classList.remove("drop"));
  bench.addEventListener("drop", (event) => { event.preventDefault(); bench.classList.remove("drop"); upload(event.dataTransfer.files[0]); });
  sheet.canvas.addEventListener("keydown", (event) => { if (tools.key(event)) { event.preventDefault(); event.stopImmediatePropagation(); } }, true);
  document.addEventListener("keydown", keys);
}

function keys(event) {
  const typing = event.target.closest("input:not([type=checkbox]):not([type=range]), select, pre");
  const press = (id) => { event.preventDefault(); if (!by(id).disabled) by(id).click(); };
  if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "z" && !typing) return press(event.shiftKey ? "redo" : "undo");
  if (typing || event.ctrlKey || event.metaKey || event.altKey) return;
  const pressed = { n: "step", Escape: "stop", r: "run-button" }[event.key];
  if (pressed) return press(pressed);
  if (event.key === " " && !event.target.closest("button, summary, input, a")) return press("hold");
  const tool = { v: "look", m: "measure", c: "corners", s: "start", x: "rub", b: "bridge" }[event.key];
  if (tool) tools.take(tool);
}

function onFrame(frame) {
  if (!sheet) return;
  if (frame.state) show(frame.state);
  if (frame.head) {
    head.busy = Boolean(state?.busy && state.busy.kind !== "lines");
    if (frame.head.fresh.length || frame.head.life !== head.life || head.busy !== head.was || frame.head.words) head.add(frame.head);
    head.was = head.busy;
    showWords(frame.head.words);
  }
}

function show(next) {
  const before = state;
  state = next;
  by("title").textContent = state.drawing ?? "no drawing";
  by("empty").hidden = state.drawing !== null;
  by("undo").disabled = !state.can_undo;
  by("redo").disabled = !state.can_redo;
  fields.show(state.options);
  showSources();
  showSize();
  sheet.show(state.picture, state.sheet?.pitch_mm ?? null);
  const lines = state.sheet?.figures.lines ?? [];
  if (JSON.stringify([before?.options, before?.sheet]) !== JSON.stringify([state.options, state.sheet])) {
    sheet.recolour((number) => isChosen(state.options, lines, number));
    showWhich(by("which"), state.options, set);
    showLines(by("lines"), state, set, under);
    showCorrections(by("corrections"), state, goTo, async (number) => say((await link.do({ do: "correct", remove: number })) ?? ""));
  }
  showBusy();
  showCommands();
  showSaves(by("save"), state, save);
  showFiles(by("files"), state.files);
  by("messages-card").hidden = state.messages.length === 0;
  showMessages(by("messages"), state.messages, goTo);
  takeResult();
}

function showSources() {
  const list = by("sources"), now = state.sources.join("/") + state.drawing;
  if (list.dataset.shown === now) return;
  list.dataset.shown = now;
  const first = state.drawing ? [] : [element("option", { value: "" }, state.sources.length ? "choose a drawing" : "none yet")];
  list.replaceChildren(...first, ...state.sources.map((name) => element("option", { value: name }, name)));
  list.value = state.drawing ?? "";
}

function showSize() {
  const { picture, sheet: seen, refused } = state;
  const size = seen ? `${seen.width_mm.toFixed(1)} × ${seen.height_mm.toFixed(1)} mm, ${(25.4 / seen.pitch_mm).toFixed(0)} dpi` : "";
  const pixels = picture ? `${picture.columns} × ${picture.rows} pixels` : "";
  const looking = state.busy?.kind === "lines" ? "looking for lines …" : "";
  by("size").textContent = [size, pixels, looking].filter(Boolean).join(" · ");
  by("refused").textContent = refused ?? "";
}

function showBusy() {
  const { busy } = state, runs = busy !== null && busy.kind !== "lines";
  by("run-button").disabled = runs || !state.sheet;
  for (const id of ["hold", "step", "stop"]) by(id).disabled = !runs;
  by("hold").textContent = busy?.held ? "Go on" : "Hold";
  by("progress").value = busy?.share ?? (result ? 1 : 0);
  head.busy = runs;
  sheet.strength = runs ? 0.35 : result ? 0.12 : 1; // the head's path, and the error's colours, stand out
  sheet.ask();
  if (!runs) head.drawInset();
  showWords(null);
}

function showWords(words) {
  const { busy } = state;
  if (words) showWords.last = words;
  let text = result ? (result.faults.length ? "ended early" : "done") : state.sheet ? "ready" : "no lines yet";
  if (busy && busy.kind !== "lines") {
    const doing = busy.what === "following the line" ? `the head is ${at(showWords.last ?? "")}` : busy.what || "begins";
    text = busy.held ? `held: ${doing}` : `${doing} · ${Math.round(100 * busy.share)} %`;
  } else if (busy) text = "looking for lines";
  by("words").textContent = text;
}

function at(words) {
  return words.startsWith("lost") ? words : words || "put down";
}

function showCommands() {
  const list = by("command-kind"), kinds = Object.keys(state.commands), now = kinds.join("/");
  if (list.dataset.shown !== now) {
    const before = list.value || "run";
    list.dataset.shown = now;
    list.replaceChildren(...kinds.map((kind) => element("option", { value: kind }, { run: "run", lines: "look", correct: "correct", program: "save program" }[kind] ?? `save ${kind}`)));
    list.value = kinds.includes(before) ? before : (kinds[1] ?? "");
  }
  showCommand();
}

function showCommand() {
  by("command").textContent = state.commands[by("command-kind").value] ?? "morfax panel";
}

async function takeResult() {
  const now = JSON.stringify(state.result?.of ?? null) + state.files.join() + (state.busy?.kind === "run");
  by("stale").hidden = !state.result || state.result.is_of_now;
  if (now === shownResult) return;
  shownResult = now;
  const answer = state.result ? await fetch("/result").catch(() => null) : null;
  const taken = answer?.ok ? await answer.json() : null;
  if (now !== shownResult) return;
  const before = takeResult.ran;
  takeResult.ran = true;
  const same = taken && result && JSON.stringify(taken.figures) === JSON.stringify(result.figures);
  result = taken;
  by("result-card").hidden = by("machine").hidden = !result;
  by("legend").hidden = !result;
  showBusy();
  if (same) return;
  replay?.close();
  replay = null;
  drawResult.now = null;
  if (result) {
    const largest = errorScale(result.error);
    result.paths = errorPaths(result.error, largest);
    showResult(result, goTo);
    if (state.busy === null && before) by("result-card").scrollIntoView({ block: "start", behavior: "smooth" });
    showLegend(by("legend"), largest);
    replay = new Replay(by("machine"), result, (now) => { drawResult.now = now; sheet.ask(); });
  }
  head.isHidden = Boolean(result);
  sheet.ask();
}

function drawResult(context) {
  if (!result?.paths || !sheet.pitch || (state.busy && state.busy.kind !== "lines")) return;
  const perMm = sheet.view.scale / sheet.pitch, unit = devicePixelRatio / perMm;
  const [x0, y0] = sheet.toScreen(sheet.toPx([0, 0]));
  const style = getComputedStyle(sheet.canvas);
  context.setTransform(perMm, 0, 0, -perMm, x0, y0);
  drawErrors(context, result.paths, 3 * unit);
  drawWorst(context, result.worst, unit, style.getPropertyValue("--head"));
  if (drawResult.now) drawMachine(context, result.played, drawResult.now, unit, { way: "#20211f", down: style.getPropertyValue("--head"), up: "#4a7fae" });
}

function hover(x, y) {
  const number = x < 0 || tools.name !== "look" ? 0 : sheet.numberAt(x, y), note = by("hover");
  note.hidden = !number;
  sheet.canvas.style.cursor = number ? "pointer" : "";
  under(number);
  if (!number) return;
  note.textContent = lineText(state, number);
  note.style.left = `${Math.min(x / devicePixelRatio + 14, sheet.canvas.clientWidth - 190)}px`;
  note.style.top = `${y / devicePixelRatio + 14}px`;
}

function under(number) {
  for (const row of by("lines").children) row.classList.toggle("under", Number(row.dataset.row) === number);
}

function goTo(where) {
  sheet.goTo([where.x_mm, where.y_mm], 24);
  sheet.canvas.focus({ preventScroll: false });
}

async function set(options) {
  const why = await link.do({ do: "set", options });
  if (why) say(why);
}

async function open(name) {
  if (!name) return;
  const why = await link.do({ do: "open", drawing: name });
  if (why) say(why);
}

async function upload(file) {
  if (!file) return;
  say(`taking in ${file.name} …`);
  const why = await link.upload(file).catch(() => "the file could not be sent; it may be larger than 256 MB");
  say(why ?? "");
  by("upload").value = "";
}

async function save(kind) {
  const why = await link.do({ do: "save", as: kind });
  if (why) say(why);
}

async function copy() {
  try {
    await navigator.clipboard.writeText(by("command").textContent);
  } catch {
    getSelection().selectAllChildren(by("command"));
    document.execCommand("copy");
  }
  by("copy").textContent = "Copied";
  setTimeout(() => { by("copy").textContent = "Copy"; }, 1500);
}

function say(text) {
  const toast = by("refusal");
  toast.textContent = text;
  toast.hidden = !text;
  clearTimeout(say.timer);
  if (text) say.timer = setTimeout(() => { toast.hidden = true; }, 7000);
}

function theme(name) {
  document.documentElement.dataset.theme = name;
  localStorage.setItem("theme", name);
  sheet?.ask();
  if (replay && result) { replay.close(); replay = new Replay(by("machine"), result, (now) => { drawResult.now = now; sheet.ask(); }); }
}
