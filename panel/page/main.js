// The panel: what the server says is shown, what the operator does is sent. It decides nothing of its own.

import { choosing, isChosen, lineText, showCorrections, showFiles, showLines, showMessages, showSaves, showWhich } from "./cards.js";
import { Fields } from "./fields.js";
import { element } from "./format.js";
import { Head } from "./head.js";
import { drawCorrections, drawNumbers, drawStart } from "./layers.js";
import { Link } from "./link.js";
import { arrowText, drawArrows, showArrows, withArrow } from "./orders.js";
import { Outcome } from "./outcome.js";
import { Sheet } from "./sheet.js";
import { Ask, Tools } from "./tools.js";

const PACES = [[null, "fast"], [10, "10 ×"], [2, "200 %"], [1, "100 %"], [0.5, "50 %"], [0.1, "10 %"]];
const SCALE = ["--width", "--dpi"], MAIN = ["--machine", "--cutter", "--side", "--depth"];
const by = (id) => document.getElementById(id);

const link = new Link(onFrame, (is) => { by("connection").textContent = is ? "" : "no connection"; });
const fields = new Fields(link);
let sheet, head, tools, outcome, state = null;

begin();

async function begin() {
  theme(localStorage.getItem("theme") ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light"));
  const first = await link.begin().catch((error) => say(error.message));
  if (!first) return;
  sheet = new Sheet(by("sheet"), first.tile);
  const bar = document.querySelector(".tools"); // above which the sheet is shown
  new ResizeObserver(() => { sheet.below = bar.offsetHeight + 26; if (sheet.whole) sheet.all(); }).observe(bar);
  head = new Head(sheet, by("inset"), by("inset-canvas"));
  tools = new Tools(sheet, link, new Ask(), say);
  tools.onChoose = (number) => number && set(choosing(state.options, number));
  tools.onArrow = arrow;
  outcome = new Outcome(sheet, goTo, () => { head.isHidden = Boolean(outcome.result); showBusy(); }, (share) => act({ do: "override", share }));
  const calm = () => !outcome.result && !runs();
  sheet.ground.layers.push((c) => drawCorrections(c, sheet, state), (c) => calm() && drawNumbers(c, sheet, state));
  sheet.layers.push((c) => drawStart(c, sheet, state), (c) => state && drawArrows(c, sheet, state.options));
  sheet.onHover = hover;
  placeFields(first.fields);
  wire();
  globalThis.panel = { sheet, head, link }; // for whoever looks at the page from its console
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
  fields.place(by("fields-card"), group("Card", []));
  fields.place(by("fields-rest"), [...group("Head", []), ...group("Placement", [])]);
  by("pace").append(...PACES.map(([times, text]) => element("option", { value: times ?? "" }, text)));
}

function wire() {
  const press = (id, action) => by(id).addEventListener("click", () => act(action()));
  press("run-button", () => ({ do: "run" }));
  press("hold", () => ({ do: state.busy?.held ? "resume" : "hold" }));
  for (const id of ["step", "stop", "undo", "redo"]) press(id, () => ({ do: id }));
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
  const tool = { v: "look", m: "measure", c: "corners", s: "start", a: "arrow", x: "rub", b: "bridge" }[event.key];
  if (tool) tools.take(tool);
}

function onFrame(frame) {
  if (!sheet) return;
  if (frame.state) show(frame.state);
  if (frame.head) {
    head.busy = follows();
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
  fields.show(state.options, state.own);
  showSources();
  showSize();
  sheet.show(state.picture, state.sheet?.pitch_mm ?? null);
  if (JSON.stringify([before?.options, before?.sheet]) !== JSON.stringify([state.options, state.sheet])) {
    sheet.recolour((number) => isChosen(state, number));
    showWhich(by("which"), state, set);
    showLines(by("lines"), state, set, under);
    showArrows(by("arrows"), state.options, goTo, set);
    showCorrections(by("corrections"), state, goTo, (number) => act({ do: "correct", remove: number }));
  }
  showBusy();
  showCommands();
  showSaves(by("save"), state, save);
  showFiles(by("files"), state.files);
  by("messages-card").hidden = state.messages.length === 0;
  showMessages(by("messages"), state.messages, goTo);
  outcome.take(state);
}

function runs() {
  return Boolean(state?.busy && state.busy.kind !== "lines");
}

// Whether the head is at work, and not the machine.
function follows() {
  return runs() && state.busy.kind !== "play";
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
  const { busy } = state, { result } = outcome, at = follows();
  by("run-button").disabled = runs() || !state.sheet;
  for (const id of ["hold", "step", "stop"]) by(id).disabled = !runs();
  by("hold").textContent = busy?.held ? "Go on" : "Hold";
  by("progress").value = busy?.share ?? (result ? 1 : 0);
  head.busy = at;
  const strength = at ? 0.35 : result ? 0.12 : 1; // the head's path, and the error's colours, stand out
  if (strength !== sheet.strength || outcome.hidden !== at) {
    Object.assign(sheet, { strength });
    outcome.hidden = at;
    sheet.renew();
  }
  sheet.ask();
  if (!at) head.drawInset();
  showWords(null);
}

function showWords(words) {
  const { busy } = state;
  if (words) showWords.last = words;
  const { result } = outcome;
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
    list.replaceChildren(...kinds.map((kind) => element("option", { value: kind }, { run: "run", lines: "look", correct: "correct", play: "play", program: "save program" }[kind] ?? `save ${kind}`)));
    list.value = kinds.includes(before) ? before : (kinds[1] ?? "");
  }
  showCommand();
}

function showCommand() {
  by("command").textContent = state.commands[by("command-kind").value] ?? "morfax panel";
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

async function act(action) {
  const why = await link.do(action);
  if (why) say(why);
  return why;
}

function set(options) {
  return act({ do: "set", options });
}

function open(name) {
  if (name) act({ do: "open", drawing: name });
}

// A line begins there, and goes that way; an arrow that begins as near is taken away.
function arrow(drawn) {
  const near = (12 * devicePixelRatio * sheet.pitch) / sheet.view.scale, whole = state.options["--lines"] === "all" ? { "--lines": "contours" } : {};
  return link.do({ do: "set", options: { ...whole, "--start": null, "--direction": null, "--arrow": arrowText(withArrow(state.options, drawn, near)) } });
}

async function upload(file) {
  if (!file) return;
  say(`taking in ${file.name} …`);
  const sent = file.name.toLowerCase().endsWith(".toml") ? link.own(file, "any") : link.upload(file);
  const why = await sent.catch(() => "the file could not be sent; it may be larger than 256 MB");
  say(why ?? "");
  by("upload").value = "";
}

function save(kind) {
  return act({ do: "save", as: kind });
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
  sheet?.renew();
  if (outcome?.result) outcome.show(outcome.replay.share);
}
