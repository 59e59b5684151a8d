// Beside the pointer, while a connection is made: why what is below it does not fit, or what changes.

import { useEffect, useState } from "react";

import type { Point } from "../model/rects";
import { endAt } from "../model/ends";
import { getStage } from "../actions/stage";
import { groupHintOf, type Hint, hintOf, useWiring } from "../actions/wiring";

export function WiringHint() {
  const known = useWiring(({ wiring }) => wiring?.fits != null);
  const [said, setSaid] = useState<(Point & Hint) | null>(null);
  useEffect(() => {
    setSaid(null);
    if (!known) {
      return;
    }
    const move = ({ clientX: x, clientY: y }: PointerEvent) => {
      const hint = hintAt(document.elementFromPoint(x, y));
      setSaid(hint === null ? null : { x, y, ...hint });
    };
    addEventListener("pointermove", move);
    return () => removeEventListener("pointermove", move);
  }, [known]);
  if (!known || said === null) {
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

function hintAt(at: Element | null): Hint | null {
  const { wiring } = useWiring.getState();
  const node = at?.closest(".react-flow__node")?.getAttribute("data-id");
  if (wiring === null || wiring.fits === null || node == null) {
    return null;
  }
  const judged = { ...wiring, fits: wiring.fits };
  const handle = at?.closest(".react-flow__handle")?.getAttribute("data-handleid") ?? null;
  const scene = getStage()
    ?.scene()
    .nodes.find(({ id }) => id === node);
  if (scene?.type === "folded" && handle === null) {
    return groupHintOf(judged, [...scene.data.inputs, ...scene.data.outputs]);
  }
  const { element, port } = endAt(node, handle);
  return scene?.type === "box" || scene?.type === "folded" ? hintOf(judged, element, port) : null;
}
