// The picture of a model in the palette; without one, connected boxes.

import { useState } from "react";

import type { TemplateView } from "../../protocol";

type Props = { template: TemplateView; className: string };

export function TemplatePicture({ template: { picture }, className }: Props) {
  const [missing, setMissing] = useState(picture === "");
  return missing ? (
    <svg className={`sketch ${className}`} viewBox="0 0 38 24" aria-hidden="true">
      <path className="sketch-faint" d="M14,7H20V17H24M14,17H24" />
      <path className="sketch-line" d="M4,4H14V10H4ZM4,14H14V20H4ZM24,14H34V20H24Z" />
    </svg>
  ) : (
    <img
      className={className}
      src={picture}
      alt=""
      loading="lazy"
      draggable={false}
      onError={() => setMissing(true)}
    />
  );
}
