// Fields: each is an option of the command line, with its own words for help; the server refuses what a terminal refuses.

import { element, named } from "./format.js";

const WIDE = ["--card", "--settings", "--arrow", "--flatten", "--known", "--machine", "--start", "--reference-point"];
const UNITS = { "--gap": "0.5mm", "--speed": "10mm/s", "--depth": "5mm", "--clearance": "2mm" };
const SHORT = { "--machine": "none: record a tape", "--side": "outside", "--cutter": "on the line", "--width": "such as 210mm", "--dpi": "from the file", "--card": "none", "--settings": "the head's own", "--arrow": "40,26 50,26", "--order": "3,1" };

export class Fields {
  constructor(link) {
    this.link = link;
    this.made = new Map();
  }

  place(host, fields) {
    for (const field of fields) host.append(this.field(field));
  }

  field(field) {
    const id = `field${field.option}`, refused = element("p", { class: "refused", role: "alert", id: `${id}-refused` });
    const help = element("p", { class: "help", id: `${id}-help` }, field.help);
    const attributes = { id, "aria-describedby": `${id}-help ${id}-refused`, "data-option": field.option };
    const control = this.control(field, attributes);
    const label = element("label", { for: id }, named(field.option));
    const wide = WIDE.includes(field.option) ? " wide" : "";
    const shown = field.kind === "file" ? this.file(field, control, refused) : control;
    const parts = field.kind === "switch" ? [control, label] : [label, shown];
    control.addEventListener("change", () => this.set(field, control, refused));
    this.made.set(field.option, { field, control, refused });
    return element("div", { class: `field ${field.kind}${wide}` }, ...parts, refused, help);
  }

  // A list of files, and a button that takes in another.
  file(field, select, refused) {
    const input = element("input", { type: "file", class: "hush", accept: ".toml", "aria-label": `${named(field.option)}: a file of your own`, "data-own": field.option });
    input.addEventListener("change", async () => {
      const why = await this.link.own(input.files[0], field.option).catch(() => "the file could not be sent");
      input.value = "";
      this.refuse(select, refused, why);
    });
    return element("div", { class: "row" }, select, element("label", { class: "button", title: "A file of your own (.toml)" }, "…", input));
  }

  control(field, attributes) {
    if (field.kind === "switch") return element("input", { type: "checkbox", ...attributes });
    if (field.kind === "choice" || field.kind === "file") {
      const usual = SHORT[field.option] ?? this.usual(field);
      const options = field.choices.map((choice) => element("option", { value: choice }, choice));
      return element("select", attributes, element("option", { value: "" }, usual), ...options);
    }
    const placeholder = SHORT[field.option] ?? this.usual(field);
    return element("input", { type: "text", autocomplete: "off", spellcheck: "false", placeholder, ...attributes });
  }

  // The built-in choices and the operator's own files.
  offer(field, control, own) {
    if (control.dataset.own === own.join("/")) return;
    control.dataset.own = own.join("/");
    const usual = control.options[0], options = [...field.choices, ...own].map((name) => element("option", { value: name }, name));
    control.replaceChildren(usual, ...options);
    control.dataset.shown = "";
  }

  usual(field) {
    if (UNITS[field.option]) return UNITS[field.option];
    const told = /\[default: ([^\]]*)\]/.exec(field.help);
    return told ? told[1] : "not set";
  }

  async set(field, control, refused) {
    const value = field.kind === "switch" ? control.checked : control.value.trim();
    const why = await this.link.do({ do: "set", option: field.option, value: value || null });
    this.refuse(control, refused, why);
  }

  refuse(control, refused, why) {
    refused.textContent = why ?? "";
    control.setAttribute("aria-invalid", why ? "true" : "false");
  }

  // Show what is set; a field that holds something refused keeps it until it is changed.
  show(options, own = []) {
    for (const [option, { field, control, refused }] of this.made) {
      if (field.kind === "file") this.offer(field, control, own);
      const value = options[option] ?? "";
      if (field.kind === "switch") control.checked = value === true;
      else if (refused.textContent && control.dataset.shown === String(value)) continue;
      else if (document.activeElement !== control || control.dataset.shown !== String(value)) control.value = value;
      if (control.dataset.shown !== String(value)) {
        refused.textContent = "";
        control.setAttribute("aria-invalid", "false");
      }
      control.dataset.shown = String(value);
    }
  }
}
