// Tiles: squares of the sheet and of its lines, loaded when they are asked for; the newest are kept.

export const COLOURS = ["#1f5fa8", "#c1121f", "#2a8f4f", "#8a3fa0", "#c26a10", "#0f8b8d", "#b5338a", "#6b4f1d"];
export const LETTERING = 65534;
const LEFT_OUT = 65535;
const MOST_TILES = 160; // 3 MB each at most

export function colourOf(number) {
  return COLOURS[(number - 1) % COLOURS.length];
}

// None of a sheet that has changed since; a server that ends in the middle throws.
async function squareAt(address) {
  const answer = await fetch(address);
  return answer.status === 200 ? answer.blob() : null;
}

export class Tiles {
  constructor(size, onLoaded) {
    this.size = size;
    this.onLoaded = onLoaded;
    this.kept = new Map();
    this.chosen = () => true;
    this.id = 0;
  }

  clear(id) {
    this.id = id;
    this.forget("");
  }

  forget(kind) {
    for (const key of [...this.kept.keys()]) if (key.startsWith(kind)) this.drop(key);
  }

  // Bitmaps are given back at once: a collector of garbage does not see how large they are.
  drop(key) {
    const tile = this.kept.get(key);
    this.kept.delete(key);
    for (const bitmap of [tile.image, tile.painted, tile.combined]) bitmap?.close();
    tile.dropped = true;
  }

  get(key) {
    return this.kept.get(key);
  }

  recolour(chosen) {
    this.chosen = chosen;
    for (const tile of this.kept.values()) {
      tile.painted?.close();
      tile.painted = null;
    }
  }

  of(kind, level, column, row) {
    const key = `${kind} ${level} ${column} ${row}`;
    let tile = this.kept.get(key);
    if (tile) {
      this.kept.delete(key); // the newest stands last
      this.kept.set(key, tile);
      return tile;
    }
    tile = { image: null, numbers: null, painted: null };
    this.kept.set(key, tile);
    if (this.kept.size > MOST_TILES) this.drop(this.kept.keys().next().value);
    this.load(tile, kind, level, column, row);
    return tile;
  }

  async load(tile, kind, level, column, row) {
    const square = await squareAt(`/tile/${this.id}/${kind}/${level}/${column}/${row}`).catch(() => null);
    if (!square) return;
    const options = { premultiplyAlpha: "none", colorSpaceConversion: "none" };
    const image = await createImageBitmap(square, options);
    if (tile.dropped) return image.close();
    if (kind === "lines") {
      const canvas = new OffscreenCanvas(image.width, image.height);
      const context = canvas.getContext("2d", { willReadFrequently: true });
      context.drawImage(image, 0, 0);
      tile.numbers = context.getImageData(0, 0, image.width, image.height);
    }
    tile.image = image;
    this.onLoaded(level, column, row);
  }

  // A tile of lines in colours: chosen lines full, the others pale, what has no number grey.
  painted(tile) {
    if (tile.painted) return tile.painted;
    const { width, height, data } = tile.numbers;
    const made = new ImageData(width, height);
    const colours = new Map();
    for (let i = 0; i < data.length; i += 4) {
      if (!data[i + 3]) continue;
      const number = data[i] + 256 * data[i + 1];
      let rgba = colours.get(number);
      if (!rgba) colours.set(number, (rgba = this.rgba(number)));
      made.data.set(rgba, i);
    }
    const canvas = new OffscreenCanvas(width, height);
    canvas.getContext("2d").putImageData(made, 0, 0);
    return (tile.painted = canvas.transferToImageBitmap());
  }

  rgba(number) {
    if (number === LEFT_OUT) return [150, 150, 150, 170];
    if (number === LETTERING) return [200, 160, 20, 170];
    const colour = parseInt(colourOf(number).slice(1), 16);
    return [colour >> 16, (colour >> 8) & 255, colour & 255, this.chosen(number) ? 235 : 90];
  }

  numberAt(level, x, y) {
    if (x < 0 || y < 0) return 0;
    const numbers = this.kept.get(`lines ${level} ${Math.floor(x / this.size)} ${Math.floor(y / this.size)}`)?.numbers;
    const [u, v] = [x % this.size, y % this.size];
    if (!numbers || u >= numbers.width || v >= numbers.height) return 0;
    const i = 4 * (v * numbers.width + u);
    return numbers.data[i + 3] ? numbers.data[i] + 256 * numbers.data[i + 1] : 0;
  }
}
