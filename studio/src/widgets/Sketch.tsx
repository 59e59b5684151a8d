// The small picture of a kind: a curve, or a sign.

import { memo, useState } from "react";

import type { Kind, TemplateView } from "../protocol";
import { useStudio } from "../server/store";
import { DRAWN, type SketchDrawing, shapeOf } from "../model/shapes";

const SIZE = { width: 38, height: 24 };

export const Sketch = memo(function Sketch({ kind }: { kind: Kind }) {
  const kinds = useStudio((state) => state.kinds);
  const shape = shapeOf(kind, kinds);
  const { line, faint, sign }: SketchDrawing = DRAWN[shape];
  return (
    <svg className="sketch" viewBox="0 0 38 24" {...SIZE} aria-hidden="true">
      {faint !== undefined && <path className="sketch-faint" d={faint} />}
      {line !== undefined && <path className="sketch-line" d={line} />}
      {sign !== undefined && (
        <text className="sketch-sign" x="19" y="17.5" textAnchor="middle">
          {sign}
        </text>
      )}
    </svg>
  );
});

type Props = { template: TemplateView; className: string };

// The picture of a model; without one, connected boxes.
export function TemplatePicture({ template: { picture }, className }: Props) {
  const [missing, setMissing] = useState(picture === "");
  const failed = () => setMissing(true);
  return missing ? (
    <svg className={`sketch ${className}`} viewBox="0 0 38 24" aria-hidden="true">
      <path className="sketch-faint" d="M14,7H20V17H24M14,17H24" />
      <path className="sketch-line" d="M4,4H14V10H4ZM4,14H14V20H4ZM24,14H34V20H24Z" />
    </svg>
  ) : (
    <img className={className} src={picture} alt="" loading="lazy" draggable={false} onError={failed} />
  );
}
