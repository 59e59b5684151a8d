// Beside the pointer, while a connection is made: why the element below it does not fit, or what changes.

import { useEffect, useState } from "react";

import type { Point } from "../graph/layout";
import { fitOf, useWiring } from "./wiring";

export function WiringHint() {
  const fits = useWiring(({ wiring }) => wiring?.fits ?? null);
  const [said, setSaid] = useState<(Point & { text: string; ok: boolean }) | null>(null);
  useEffect(() => {
    setSaid(null);
    if (fits === null) {
      return;
    }
    const move = ({ clientX: x, clientY: y }: PointerEvent) => {
      const at = document.elementFromPoint(x, y);
      const box = at?.closest(".react-flow__node-box")?.getAttribute("data-id");
      const port = at?.closest(".react-flow__handle")?.getAttribute("data-handleid") ?? null;
      const fit = box == null ? undefined : fitOf(fits, box, port);
      setSaid(fit === undefined || fit.reason === "" ? null : { x, y, text: fit.reason, ok: fit.fits });
    };
    addEventListener("pointermove", move);
    return () => removeEventListener("pointermove", move);
  }, [fits]);
  if (fits === null || said === null) {
    return null;
  }
  const right = innerWidth - said.x < 280 ? { right: innerWidth - said.x + 14 } : { left: said.x + 14 };
  return (
    <div
      className="wiring-hint"
      role="status"
      data-ok={said.ok || undefined}
      style={{ ...right, top: said.y + 16 }}
    >
      {said.text}
    </div>
  );
}
