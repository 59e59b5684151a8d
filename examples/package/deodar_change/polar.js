// Values over a periodic axis as a closed curve. The angle is the position, with 0 at the right and
// counter-clockwise; the distance from the middle is the value. The studio calls `draw` for each new frame, and
// after a change of size or colours.

export function draw(canvas, { values, axes, width, height, ratio, colors }) {
  const [axis] = axes;
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  const radius = Math.max(10, Math.min(width, height) / 2 - 20);
  const lowest = Math.min(0, ...values);
  const highest = Math.max(1, ...values);
  const at = (value, position) => {
    const angle = (2 * Math.PI * position) / (axis.upper - axis.lower);
    const length = (radius * (value - lowest)) / (highest - lowest);
    return [width / 2 + length * Math.cos(angle), height / 2 - length * Math.sin(angle)];
  };

  // the outer circle is the highest value, the dashed one is 0
  context.lineWidth = 1;
  context.strokeStyle = colors.dim;
  for (const value of [0, highest]) {
    context.setLineDash(value === 0 ? [4, 4] : []);
    context.beginPath();
    context.arc(width / 2, height / 2, (radius * (value - lowest)) / (highest - lowest), 0, 2 * Math.PI);
    context.stroke();
  }
  context.setLineDash([]);
  context.font = "11px system-ui, sans-serif";
  context.fillStyle = colors.text;
  context.textBaseline = "middle";
  for (let quarter = 0; quarter < 4; quarter++) {
    const position = axis.lower + ((axis.upper - axis.lower) * quarter) / 4;
    const [x, y] = at(highest + (10 * (highest - lowest)) / radius, position);
    const side = Math.round(x - width / 2);
    context.textAlign = side > 0 ? "left" : side < 0 ? "right" : "center";
    context.fillText(`${position} ${axis.unit}`.trim(), x, y);
  }

  context.lineWidth = 2;
  context.strokeStyle = colors.curves[0];
  context.beginPath();
  values.forEach((value, i) => context.lineTo(...at(value, axis.points[i])));
  context.closePath();
  context.stroke();
}
