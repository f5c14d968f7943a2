// The ruler along the upper edge: mm of the sheet, or pixels of the picture while it has no scale.

export function drawRuler(context, sheet, style) {
  const { canvas, view, pitch } = sheet, ratio = devicePixelRatio;
  const perUnit = view.scale / (pitch ?? 1); // screen pixels to a mm, or to a pixel of the picture
  const step = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000].find((s) => s * perUnit > 7 * ratio) ?? 1000;
  const height = 20 * ratio;
  context.fillStyle = style.getPropertyValue("--ruler");
  context.fillRect(0, 0, canvas.width, height);
  context.fillStyle = context.strokeStyle = style.getPropertyValue("--soft");
  context.font = `${10 * ratio}px system-ui, sans-serif`;
  context.lineWidth = ratio;
  context.beginPath();
  const first = Math.ceil((view.x * (pitch ?? 1)) / step);
  for (let k = first; ; k++) {
    const x = Math.round(k * step * perUnit - view.x * view.scale) + 0.5;
    if (x > canvas.width) break;
    const major = k % 10 === 0, half = k % 5 === 0;
    context.moveTo(x, height);
    context.lineTo(x, height - (major ? 9 : half ? 6 : 3) * ratio);
    if (major) context.fillText(`${+(k * step).toFixed(1)}${k === 0 ? (pitch ? " mm" : " px") : ""}`, x + 3 * ratio, 11 * ratio);
  }
  context.stroke();
}
