// The head at work: its path on the sheet as it grows, and the inset that follows it at twenty times its size.

const PIECE = 2000; // places to a stroke
const INSET_PX_PER_MM = 20 * 96 / 25.4; // true size twenty times

export class Head {
  constructor(sheet, inset, canvas) {
    this.sheet = sheet;
    this.inset = inset;
    this.canvas = canvas;
    this.clear(-1);
    this.busy = false;
    sheet.layers.push((context) => this.draw(context));
  }

  clear(life) {
    this.life = life;
    this.runs = [];
    this.count = 0;
    this.now = null;
  }

  // frame: {life, from, fresh: [[x, y] | "down" …], head, words}
  add(frame) {
    if (frame.life !== this.life || frame.from !== this.count) {
      this.clear(frame.life);
      if (frame.from !== 0) return;
    }
    for (const place of frame.fresh) {
      if (place === "down" || !this.runs.length) this.runs.push([new Path2D()]);
      if (place !== "down") this.put(place);
    }
    this.count += frame.fresh.length;
    this.now = frame.head ?? this.now;
    this.sheet.ask();
    this.drawInset();
  }

  put([x, y]) {
    const pieces = this.runs.at(-1);
    let piece = pieces.at(-1);
    piece.places = (piece.places ?? 0) + 1;
    if (piece.places === 1) piece.moveTo(x, y);
    else piece.lineTo(x, y);
    if (piece.places >= PIECE) {
      pieces.push((piece = new Path2D()));
      piece.moveTo(x, y);
      piece.places = 1;
    }
  }

  draw(context) {
    const { sheet } = this;
    if (!sheet.pitch || !this.runs.length || this.isHidden) return;
    const perMm = sheet.view.scale / sheet.pitch;
    const [x0, y0] = sheet.toScreen(sheet.toPx([0, 0]));
    context.setTransform(perMm, 0, 0, -perMm, x0, y0);
    context.lineJoin = "round";
    const style = getComputedStyle(sheet.canvas);
    this.runs.forEach((pieces, i) => {
      const isLast = i === this.runs.length - 1;
      context.globalAlpha = isLast ? 1 : 0.28;
      context.strokeStyle = isLast ? style.getPropertyValue("--head") : style.getPropertyValue("--soft");
      context.lineWidth = ((isLast ? 2.2 : 1.2) * devicePixelRatio) / perMm;
      for (const piece of pieces) context.stroke(piece);
    });
    if (!this.now || !this.busy) return;
    context.globalAlpha = 1;
    const r = (7 * devicePixelRatio) / perMm, { x_mm: x, y_mm: y, heading_rad: heading } = this.now;
    context.lineWidth = (1.6 * devicePixelRatio) / perMm;
    context.strokeStyle = style.getPropertyValue("--head");
    context.beginPath();
    context.arc(x, y, r, 0, 7);
    context.moveTo(x, y);
    context.lineTo(x + 2 * r * Math.cos(heading), y + 2 * r * Math.sin(heading));
    context.stroke();
  }

  drawInset() {
    const shown = this.busy && this.now && this.sheet.pitch && "x_mm" in this.now;
    this.inset.hidden = !shown;
    if (!shown) return;
    const { sheet, canvas, now } = this, context = canvas.getContext("2d");
    const size = canvas.clientWidth * devicePixelRatio || 400;
    if (canvas.width !== size) canvas.width = canvas.height = size;
    const perMm = INSET_PX_PER_MM * devicePixelRatio;
    const px = sheet.toPx([now.x_mm, now.y_mm]), scale = perMm * sheet.pitch;
    const view = { x: px[0] - size / 2 / scale, y: px[1] - size / 2 / scale, scale };
    const style = getComputedStyle(sheet.canvas);
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.fillStyle = style.getPropertyValue("--paper");
    context.fillRect(0, 0, size, size);
    if (sheet.picture) sheet.drawTiles(context, view, size, size);
    context.translate(size / 2, size / 2);
    context.scale(perMm, -perMm);
    this.drawCells(context, now, perMm, style);
  }

  drawCells(context, now, perMm, style) {
    const dot = (x, y, r) => { context.beginPath(); context.arc(x, y, r, 0, 7); };
    const unit = devicePixelRatio / perMm;
    // the drum of places
    context.fillStyle = style.getPropertyValue("--drum");
    for (const [x, y] of now.drum_mm) { dot(x - now.x_mm, y - now.y_mm, 2.2 * unit); context.fill(); }
    context.rotate(now.heading_rad);
    // the axis, and the swinging cell ahead of it
    context.strokeStyle = style.getPropertyValue("--head");
    context.lineWidth = 2 * unit;
    dot(0, 0, 5 * unit); context.stroke();
    context.beginPath();
    context.moveTo(now.lead_mm, -now.amplitude_mm);
    context.lineTo(now.lead_mm, now.amplitude_mm);
    context.moveTo(0, 0);
    context.lineTo(now.lead_mm, 0);
    context.stroke();
    context.fillStyle = style.getPropertyValue("--head");
    dot(now.lead_mm, now.middle_mm, 3.4 * unit); context.fill();
    // guard cells: left, ahead, right; full where they see ink
    const ahead = now.guard_lead_mm;
    [[ahead, now.guard_mm], [ahead, 0], [ahead, -now.guard_mm]].forEach(([x, y], i) => {
      dot(x, y, 4.5 * unit);
      context.globalAlpha = 0.15 + 0.85 * Math.min(1, now.guards[i]);
      context.fillStyle = style.getPropertyValue("--guard");
      context.fill();
      context.globalAlpha = 1;
      context.strokeStyle = style.getPropertyValue("--guard");
      context.lineWidth = 1.4 * unit;
      context.stroke();
    });
  }
}
