// Figures as people read them: lengths in mm or um, times in minutes and seconds.

export function length(mm) {
  if (mm === null || mm === undefined || !Number.isFinite(mm)) return "–";
  const size = Math.abs(mm);
  if (size < 0.1) return `${(mm * 1000).toFixed(size < 0.01 ? 1 : 0)} µm`;
  if (size < 10) return `${mm.toFixed(2)} mm`;
  return `${mm.toFixed(1)} mm`;
}

export function time(s) {
  if (!Number.isFinite(s)) return "–";
  const minutes = Math.floor(s / 60);
  return minutes ? `${minutes}:${(s % 60).toFixed(0).padStart(2, "0")} min` : `${s.toFixed(1)} s`;
}

export function place(x, y) {
  return `${x.toFixed(1)}, ${y.toFixed(1)}`;
}

export function named(option) {
  const words = option.replace(/^--/, "").replaceAll("-", " ");
  return words[0].toUpperCase() + words.slice(1);
}

export function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name === "class") made.className = value;
    else if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else if (value === true) made.setAttribute(name, "");
    else if (value !== false && value !== null && value !== undefined) made.setAttribute(name, value);
  }
  made.append(...children.filter((child) => child !== null && child !== undefined));
  return made;
}
