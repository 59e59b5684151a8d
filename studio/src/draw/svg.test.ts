import { expect, it } from "vitest";
import { SvgContext } from "./svg";

it("lines and texts are vectors, with their style", () => {
  const ctx = new SvgContext();
  ctx.strokeStyle = "#0072b2";
  ctx.lineWidth = 2;
  ctx.setLineDash([4, 3]);
  ctx.beginPath();
  ctx.moveTo(0, 1);
  ctx.lineTo(10, 1.5);
  ctx.stroke();
  ctx.font = "600 20px sans-serif";
  ctx.textAlign = "center";
  ctx.textBaseline = "middle";
  ctx.fillText('u < "v" & w', 5, 10);
  const [line, text] = ctx.content.split("\n");
  expect(line).toContain('d="M0 1L10 1.5"');
  expect(line).toContain('stroke="#0072b2" stroke-width="2"');
  expect(line).toContain('stroke-dasharray="4 3"');
  expect(text).toContain('x="5" y="17"');
  expect(text).toContain('text-anchor="middle"');
  expect(text).toContain('font-size="20" font-weight="600"');
  expect(text).toContain(">u &lt; &quot;v&quot; &amp; w</text>");
});

it("a restored state has no rotation, no clip path and the colours of before", () => {
  const ctx = new SvgContext();
  ctx.save();
  ctx.fillStyle = "#ff0000";
  ctx.beginPath();
  ctx.rect(0, 0, 8, 4);
  ctx.clip();
  ctx.translate(3, 4);
  ctx.rotate(Math.PI / 2);
  ctx.fillRect(1, 2, 3, 4);
  ctx.restore();
  ctx.fillRect(0, 0, 1, 1);
  const [clip, turned, after] = ctx.content.split("\n");
  expect(clip).toBe('<clipPath id="clip-1"><path d="M0 0h8v4h-8Z"/></clipPath>');
  // the clip path belongs to the place before the rotation
  expect(turned).toMatch(/^<g clip-path="url\(#clip-1\)"><path .*transform="matrix\(0 1 -1 0 3 4\)"/);
  expect(turned).toContain('fill="#ff0000"');
  expect(after).toBe('<path d="M0 0h1v1h-1Z" fill="#000000"/>');
});

it("a canvas is an image inside a file of a given size", () => {
  const ctx = new SvgContext();
  ctx.imageSmoothingEnabled = false;
  ctx.drawImage({ toDataURL: () => "data:image/png;base64,AAAA" }, 0, 0, 20, 10);
  const file = ctx.document(100, 50, 2);
  expect(file).toContain('width="100" height="50" viewBox="0 0 200 100"');
  expect(file).toContain('href="data:image/png;base64,AAAA"');
  expect(file).toContain("image-rendering: pixelated");
});
