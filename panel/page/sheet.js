// The sheet: tiles of the picture and of its lines on a canvas, with zoom, pan and a ruler.
//
// Coordinates: "px" are the picture's own pixels from the upper left; "mm" are the sheet's, from the lower left.

import { Ground } from "./ground.js";
import { drawRuler } from "./ruler.js";
import { LETTERING, Tiles } from "./tiles.js";

const LARGEST_SCALE = 40; // screen pixels to a pixel of the picture

export class Sheet {
  constructor(canvas, tile) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d", { alpha: false });
    this.tile = tile;
    this.tiles = new Tiles(tile, (level, column, row) => this.loaded(level, column, row));
    this.ground = new Ground(this); // what lies still
    this.layers = []; // what moves: drawn anew with each frame
    this.rest = [0, 0]; // parts of a pixel that a pan has not moved yet
    this.picture = null;
    this.pitch = null;
    this.view = { x: 0, y: 0, scale: 1 };
    this.strength = 1; // of the colours of the lines
    this.asked = false;
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.listen();
  }

  // picture: {id, rows, columns, levels, has_lines}; pitch: mm to a pixel, or null
  show(picture, pitch) {
    const other = !this.picture || !picture || picture.rows !== this.picture.rows || picture.columns !== this.picture.columns;
    if (!picture || !this.picture || picture.id !== this.picture.id) this.tiles.clear(picture?.id);
    else if (picture.has_lines !== this.picture.has_lines) this.tiles.forget("lines");
    this.picture = picture;
    this.pitch = pitch;
    if (other) this.all();
    this.renew();
  }

  // Paint everything anew.
  renew() {
    this.ground.renew();
    this.ask();
  }

  loaded(level, column, row) {
    const size = this.tile * 2 ** level;
    this.ground.touch(column * size, row * size, (column + 1) * size, (row + 1) * size);
    this.ask();
  }

  recolour(chosen) {
    this.tiles.recolour(chosen);
    this.renew();
  }

  toMm(px) {
    return this.pitch && [px[0] * this.pitch, (this.picture.rows - px[1]) * this.pitch];
  }

  toPx(mm) {
    return [mm[0] / this.pitch, this.picture.rows - mm[1] / this.pitch];
  }

  toScreen(px) {
    return [(px[0] - this.view.x) * this.view.scale, (px[1] - this.view.y) * this.view.scale];
  }

  fromScreen(x, y) {
    return [x / this.view.scale + this.view.x, y / this.view.scale + this.view.y];
  }

  all() {
    if (!this.picture) return;
    const { width, height } = this.canvas;
    // the ruler is above, the tools are below
    const [side, above, below] = [24, 32, this.below ?? 24].map((px) => px * devicePixelRatio);
    const scale = Math.min((width - 2 * side) / this.picture.columns, (height - above - below) / this.picture.rows);
    this.view.scale = Math.max(scale, 1e-4);
    this.view.x = this.picture.columns / 2 - width / 2 / this.view.scale;
    this.view.y = this.picture.rows / 2 - (height + above - below) / 2 / this.view.scale;
    this.whole = true;
    this.ask();
  }

  goTo(mm, perMm) {
    const px = this.toPx(mm);
    if (perMm) this.view.scale = Math.min(perMm * this.pitch * devicePixelRatio, LARGEST_SCALE);
    this.view.x = px[0] - this.canvas.width / 2 / this.view.scale;
    this.view.y = px[1] - this.canvas.height / 2 / this.view.scale;
    this.whole = false;
    this.ask();
  }

  zoom(by, x = this.canvas.width / 2, y = this.canvas.height / 2) {
    if (!this.picture) return;
    const [px, py] = this.fromScreen(x, y);
    const least = 0.2 * Math.min(this.canvas.width / this.picture.columns, this.canvas.height / this.picture.rows);
    this.view.scale = Math.min(Math.max(this.view.scale * by, least), LARGEST_SCALE);
    this.view.x = px - x / this.view.scale;
    this.view.y = py - y / this.view.scale;
    this.whole = false;
    this.ask();
  }

  // By whole pixels of the screen, so that what is painted can be moved; the rest waits for the next pan.
  pan(dx, dy) {
    const wanted = [dx + this.rest[0], dy + this.rest[1]], by = wanted.map(Math.round);
    this.rest = [wanted[0] - by[0], wanted[1] - by[1]];
    this.view.x -= by[0] / this.view.scale;
    this.view.y -= by[1] / this.view.scale;
    this.whole = false;
    this.ask();
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas;
    const [width, height] = [clientWidth * devicePixelRatio, clientHeight * devicePixelRatio].map(Math.round);
    if (!width || (this.canvas.width === width && this.canvas.height === height)) return;
    const middle = this.picture ? this.fromScreen(this.canvas.width / 2, this.canvas.height / 2) : [0, 0];
    this.canvas.width = width;
    this.canvas.height = height;
    if (this.whole) this.all();
    else {
      this.view.x = middle[0] - width / 2 / this.view.scale;
      this.view.y = middle[1] - height / 2 / this.view.scale;
    }
    this.draw();
  }

  ask() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => { this.asked = false; this.draw(); });
  }

  draw() {
    const { context, canvas } = this;
    const style = getComputedStyle(canvas);
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.fillStyle = style.getPropertyValue("--bench");
    context.fillRect(0, 0, canvas.width, canvas.height);
    if (!this.picture) return;
    this.ground.show(context);
    for (const layer of this.layers) {
      context.save();
      layer(context, this);
      context.restore();
    }
    drawRuler(context, this, style);
  }

  // Also for the inset, which has a view of its own.
  drawTiles(context, view, width, height, [left, top, right, bottom] = [0, 0, width, height]) {
    const level = Math.min(Math.max(0, Math.floor(-Math.log2(view.scale) + 0.25)), this.picture.levels - 1);
    const size = this.tile * 2 ** level;
    const at = (x, origin) => (x / view.scale + origin) / size;
    const first = [Math.max(0, Math.floor(at(left, view.x))), Math.max(0, Math.floor(at(top, view.y)))];
    const last = [
      Math.min(Math.ceil(this.picture.columns / size), Math.ceil(at(right, view.x))),
      Math.min(Math.ceil(this.picture.rows / size), Math.ceil(at(bottom, view.y))),
    ];
    context.imageSmoothingEnabled = view.scale < 3;
    for (let row = first[1]; row < last[1]; row++)
      for (let column = first[0]; column < last[0]; column++) {
        const both = this.picture.has_lines ? this.combined(level, column, row) : null;
        if (both) {
          this.place(context, view, "sheet", { image: both }, level, column, row, 0, 0, both.width, both.height);
          continue;
        }
        this.drawTile(context, view, "sheet", level, column, row);
        if (!this.picture.has_lines) continue;
        context.globalAlpha = this.strength;
        this.drawTile(context, view, "lines", level, column, row);
        context.globalAlpha = 1;
      }
  }

  // Sheet and lines of a tile in one picture, made once: a pan then draws half as much. Null until both are there.
  combined(level, column, row) {
    const sheet = this.tiles.of("sheet", level, column, row), lines = this.tiles.of("lines", level, column, row);
    if (!sheet.image || !lines.image) return null;
    if (sheet.over === lines.painted && lines.painted && sheet.overStrength === this.strength) return sheet.combined;
    const canvas = new OffscreenCanvas(sheet.image.width, sheet.image.height), context = canvas.getContext("2d", { alpha: false });
    context.drawImage(sheet.image, 0, 0);
    context.globalAlpha = this.strength;
    context.drawImage(this.tiles.painted(lines), 0, 0);
    sheet.combined?.close();
    Object.assign(sheet, { combined: canvas.transferToImageBitmap(), over: lines.painted, overStrength: this.strength });
    return sheet.combined;
  }

  drawTile(context, view, kind, level, column, row) {
    const tile = this.tiles.of(kind, level, column, row);
    if (tile.image) {
      this.place(context, view, kind, tile, level, column, row, 0, 0, tile.image.width, tile.image.height);
      return;
    }
    // until it is there: the part of a coarser one that is
    for (let up = 1; level + up < this.picture.levels; up++) {
      const coarse = this.tiles.get(`${kind} ${level + up} ${column >> up} ${row >> up}`);
      if (!coarse?.image) continue;
      const part = this.tile / 2 ** up;
      const [sx, sy] = [(column % 2 ** up) * part, (row % 2 ** up) * part];
      const w = Math.min(part, coarse.image.width - sx), h = Math.min(part, coarse.image.height - sy);
      if (w > 0 && h > 0) this.place(context, view, kind, coarse, level, column, row, sx, sy, w, h, 2 ** up);
      return;
    }
  }

  place(context, view, kind, tile, level, column, row, sx, sy, w, h, times = 1) {
    const size = this.tile * 2 ** level, unit = 2 ** level * times;
    const x = Math.floor((column * size - view.x) * view.scale), y = Math.floor((row * size - view.y) * view.scale);
    const right = Math.floor((column * size + w * unit - view.x) * view.scale);
    const bottom = Math.floor((row * size + h * unit - view.y) * view.scale);
    const image = kind === "lines" ? this.tiles.painted(tile) : tile.image;
    context.drawImage(image, sx, sy, w, h, x, y, right - x, bottom - y);
  }

  // The number of the line nearest to a place on the screen, within so many of its pixels; 0 for none.
  numberAt(x, y, within) {
    return this.lineAt(x, y, within).number;
  }

  // The same with the place on the line, px.
  lineAt(x, y, within = 7 * devicePixelRatio) {
    if (!this.picture?.has_lines) return { number: 0, px: null };
    const level = Math.min(Math.max(0, Math.floor(-Math.log2(this.view.scale) + 0.25)), this.picture.levels - 1);
    const unit = 2 ** level, [px, py] = this.fromScreen(x, y).map((v) => v / unit);
    const reach = Math.max(1, Math.ceil(within / this.view.scale / unit));
    let best = 0, near = Infinity, place = null;
    for (let dy = -reach; dy <= reach; dy++)
      for (let dx = -reach; dx <= reach; dx++) {
        const far = dx * dx + dy * dy;
        if (far >= near) continue;
        const number = this.tiles.numberAt(level, Math.floor(px + dx), Math.floor(py + dy));
        if (number && number < LETTERING) [best, near, place] = [number, far, [(Math.floor(px + dx) + 0.5) * unit, (Math.floor(py + dy) + 0.5) * unit]];
      }
    return { number: best, px: place };
  }

  listen() {
    const { canvas } = this, held = new Map();
    const at = (event) => {
      const box = canvas.getBoundingClientRect();
      return [(event.clientX - box.left) * devicePixelRatio, (event.clientY - box.top) * devicePixelRatio];
    };
    let far = 0;
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.exp(-event.deltaY * (event.ctrlKey ? 0.01 : 0.0015)), ...at(event));
    }, { passive: false });
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      held.set(event.pointerId, at(event));
      far = 0;
      if (held.size === 1) this.tool?.down?.(...at(event));
    });
    canvas.addEventListener("pointermove", (event) => {
      const now = at(event), before = held.get(event.pointerId);
      if (!before) return this.onHover?.(...now);
      if (held.size === 2) {
        const other = [...held].find(([id]) => id !== event.pointerId)[1];
        const apart = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]);
        this.zoom(apart(now) / Math.max(apart(before), 1), ...other);
      } else {
        far += Math.hypot(now[0] - before[0], now[1] - before[1]);
        if (!this.tool?.move?.(...now)) this.pan(now[0] - before[0], now[1] - before[1]);
      }
      held.set(event.pointerId, now);
    });
    const up = (event) => {
      const last = held.get(event.pointerId);
      held.delete(event.pointerId);
      if (!last || held.size) return;
      if (far < 5 * devicePixelRatio) this.tool?.click?.(...last);
      this.tool?.up?.(...last);
    };
    canvas.addEventListener("pointerup", up);
    canvas.addEventListener("pointercancel", (event) => held.delete(event.pointerId));
    canvas.addEventListener("pointerleave", () => this.onHover?.(-1, -1));
    canvas.addEventListener("keydown", (event) => {
      const far = (event.shiftKey ? 4 : 60) * devicePixelRatio;
      const keys = {
        ArrowLeft: () => this.pan(far, 0), ArrowRight: () => this.pan(-far, 0),
        ArrowUp: () => this.pan(0, far), ArrowDown: () => this.pan(0, -far),
        "+": () => this.zoom(1.4), "=": () => this.zoom(1.4), "-": () => this.zoom(1 / 1.4), 0: () => this.all(),
      };
      if (event.ctrlKey || event.metaKey || !keys[event.key]) return;
      event.preventDefault();
      keys[event.key]();
    });
  }
}
