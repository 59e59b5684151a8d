// The place of a drawing on the page.

import { useEffect, useRef } from "react";
import type { Content } from "../draw/content";
import { Drawing } from "./Drawing";
import type { Injection } from "./injection/spot";
import { useLatest } from "../widgets/useLatest";
import "./plots.css";

type PlaceProps = {
  label: string;
  // Of a place that takes keys.
  name?: string;
  injection: ((content: Content) => Injection) | null;
  keep: (drawing: Drawing | null) => void;
};

export function DrawingPlace({ label, name, injection, keep }: PlaceProps) {
  const host = useRef<HTMLDivElement>(null);
  const latest = useLatest({ label, injection, keep });
  const pushes = injection !== null;
  useEffect(() => {
    if (host.current === null) {
      return;
    }
    const drawing = new Drawing(host.current, {
      label: () => latest.current.label,
      injection: pushes ? (content) => latest.current.injection?.(content) ?? null : null,
    });
    const { keep: keeping } = latest.current;
    keeping(drawing);
    return () => {
      keeping(null);
      drawing.end();
    };
  }, [latest, pushes]);
  const group = name === undefined ? {} : { tabIndex: 0, role: "group", "aria-label": name };
  return <div ref={host} className="plot-host" {...group} />;
}
