// The ground: the sheet's tiles and all that lies still on it, in a bitmap of the view's size. A pan moves the bitmap
// and paints only the strips that come into view; a zoom, another picture or another result paints it anew.

export class Ground {
  constructor(sheet) {
    this.sheet = sheet;
    this.layers = []; // (context, sheet, rect): what lies still; rect in screen pixels [left, top, right, bottom]
    this.at = null; // the view that is painted; null: nothing that is still right
    this.touched = []; // parts of the picture to be painted anew, px
  }

  renew() {
    this.at = null;
  }

  touch(left, top, right, bottom) {
    if (this.at) this.touched.push([left, top, right, bottom]);
  }

  show(context) {
    const { canvas, view } = this.sheet, { width, height } = canvas;
    if (this.now?.width !== width || this.now?.height !== height) {
      [this.now, this.spare] = [0, 1].map(() => new OffscreenCanvas(width, height));
      this.at = null;
    }
    const rects = this.moved(view, width, height);
    for (const px of this.touched.splice(0)) rects.push([...this.sheet.toScreen(px.slice(0, 2)).map(Math.floor), ...this.sheet.toScreen(px.slice(2)).map(Math.ceil)]);
    const own = this.now.getContext("2d", { alpha: false });
    for (const rect of rects) this.paint(own, clipped(rect, width, height));
    this.at = { ...view };
    context.drawImage(this.now, 0, 0);
  }

  // Move what is painted along with the view; the rectangles that are still to be painted.
  moved(view, width, height) {
    const { at } = this, whole = [[0, 0, width, height]];
    if (!at || at.scale !== view.scale) return whole;
    const [dx, dy] = [(at.x - view.x) * view.scale, (at.y - view.y) * view.scale], x = Math.round(dx), y = Math.round(dy);
    if (Math.abs(dx - x) > 1e-3 || Math.abs(dy - y) > 1e-3 || Math.abs(x) >= width || Math.abs(y) >= height) return whole;
    if (!x && !y) return [];
    const context = this.spare.getContext("2d", { alpha: false });
    context.globalCompositeOperation = "copy";
    context.drawImage(this.now, x, y);
    context.globalCompositeOperation = "source-over";
    [this.now, this.spare] = [this.spare, this.now];
    const rects = [];
    if (x) rects.push(x > 0 ? [0, 0, x, height] : [width + x, 0, width, height]);
    if (y) rects.push(y > 0 ? [0, 0, width, y] : [0, height + y, width, height]);
    return rects;
  }

  paint(context, rect) {
    const { sheet } = this, [left, top, right, bottom] = rect;
    if (right <= left || bottom <= top) return;
    const style = getComputedStyle(sheet.canvas);
    context.save();
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.beginPath();
    context.rect(left, top, right - left, bottom - top);
    context.clip();
    context.fillStyle = style.getPropertyValue("--bench");
    context.fillRect(left, top, right - left, bottom - top);
    const corner = sheet.toScreen([0, 0]), size = [sheet.picture.columns * sheet.view.scale, sheet.picture.rows * sheet.view.scale];
    context.fillStyle = style.getPropertyValue("--shade");
    context.fillRect(corner[0] + devicePixelRatio, corner[1] + 2 * devicePixelRatio, ...size);
    context.fillStyle = style.getPropertyValue("--paper");
    context.fillRect(...corner, ...size);
    sheet.drawTiles(context, sheet.view, sheet.canvas.width, sheet.canvas.height, rect);
    for (const layer of this.layers) {
      context.save();
      layer(context, sheet, rect);
      context.restore();
    }
    context.restore();
  }
}

function clipped([left, top, right, bottom], width, height) {
  return [Math.max(0, left), Math.max(0, top), Math.min(width, right), Math.min(height, bottom)];
}
