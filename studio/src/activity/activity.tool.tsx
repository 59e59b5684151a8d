// The tool of activity: the greatest activation of each element with a threshold over the newest times, in
// the order of the canvas. A line selects its element and shows it there.

import "./activity.css";

import { memo, useCallback, useEffect, useMemo, useRef, useState } from "react";

import { paintHeat } from "../draw/paint";
import { grouped } from "../draw/text";
import { useStructure } from "../architecture/structure";
import { canvasOrder } from "../architecture/order";
import { showGoal } from "../actions/showGoal";
import { useLevels } from "../widgets/useLevels";
import { useStreams } from "../plots/useStreams";
import type { ElementView } from "../protocol";
import type { DockTool } from "../state/tool";
import { type Studio, useStudio } from "../server/store";
import type { Live, Wish } from "../server/streams";
import { unitText } from "../model/format";
import { paced } from "../state/throttled";
import { choosing, useOptions } from "../widgets/useOptions";
import { useVisible } from "../widgets/useVisible";
import { COLUMNS, STRIP_COLORS, STRIP_RANGE, STRIP_TIME, stripOf } from "./strip";

const PORT = "activation";

export const tool: DockTool = { title: "Activity", component: ActivityPanel };

function ActivityPanel() {
  const structure = useStructure();
  const kinds = useStudio((state) => state.kinds);
  const unit = useStudio((state) => state.document?.time_unit ?? "");
  const frames = useMemo(() => {
    const hasThreshold = ({ kind }: ElementView) =>
      kinds.get(kind)?.levels[PORT]?.["threshold"] !== undefined;
    return (structure === null ? [] : canvasOrder(structure, kinds))
      .map(({ title, elements }) => ({ title, elements: elements.filter(hasThreshold) }))
      .filter(({ elements }) => elements.length > 0);
  }, [structure, kinds]);
  const keys = frames.flatMap(({ elements }) => elements.map(({ id }) => id));
  const { active, setLast, onKeyDown } = useOptions(keys);
  if (keys.length === 0) {
    return <p className="activity dim">No element of this document has an activation with a threshold.</p>;
  }
  return (
    <div className="activity">
      <p className="dim">
        Greatest activation, the newest {STRIP_TIME} {unitText(unit) || "time units"}. Bold and ember: above
        the threshold.
      </p>
      <div role="listbox" aria-label="Activity of elements" onKeyDown={onKeyDown}>
        {frames.map(({ title, elements }) => (
          <div key={title} role="group" aria-label={title || "Elements"}>
            {title !== "" && (
              <div className="activity-frame fine" aria-hidden>
                {title}
              </div>
            )}
            {elements.map(({ id, name, path }) => (
              <Line key={id} element={id} name={name} path={path} active={id === active} onFocus={setLast} />
            ))}
          </div>
        ))}
      </div>
    </div>
  );
}

type ActivityLineProps = Readonly<{
  element: string;
  name: string;
  path: string;
  active: boolean;
  onFocus: (element: string) => void;
}>;

// Out of view it asks for no data.
const Line = memo(function Line({ element, name, path, active, onFocus }: ActivityLineProps) {
  const selected = useStudio((state) => state.selected.includes(element));
  const line = useRef<HTMLDivElement>(null);
  const visible = useVisible(line, false);
  const [above, setAbove] = useState(false);
  return (
    <div
      ref={line}
      className="activity-line"
      role="option"
      title={path}
      tabIndex={active ? 0 : -1}
      aria-selected={selected}
      data-above={above || undefined}
      onFocus={() => onFocus(element)}
      {...choosing(() => showGoal({ element }))}
    >
      <span className="activity-name">{name}</span>
      {visible && <StripAndValue element={element} setAbove={setAbove} />}
    </div>
  );
});

type StripProps = Readonly<{ element: string; setAbove: (above: boolean) => void }>;

function StripAndValue({ element, setAbove }: StripProps) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const value = useRef<HTMLSpanElement>(null);
  const live = useRef<Live | null>(null);
  const draw = useCallback(() => {
    const end = shownTime(useStudio.getState());
    const strip = live.current === null ? null : stripOf(live.current.history, end, levels.current);
    setAbove(strip?.above ?? false);
    if (canvas.current !== null && value.current !== null) {
      const columns = strip?.columns ?? new Float32Array(COLUMNS).fill(NaN);
      paintHeat(canvas.current, columns, COLUMNS, 1, STRIP_RANGE, STRIP_COLORS);
      value.current.textContent = strip === null ? "" : grouped(strip.newest, 1);
    }
  }, [setAbove]);
  const { later, end } = useMemo(() => paced(draw, PACE_MS), [draw]);
  useEffect(() => end, [end]);
  const levels = useLevels(element, PORT, later);
  const wishes: Wish[] = [{ type: "trace", element, port: PORT, reduce: "max", at: [] }];
  const { lost } = useStreams(wishes, true, ([now]) => {
    live.current = now ?? null;
    later();
  });
  useEffect(
    () =>
      useStudio.subscribe((state, before) => {
        if (shownTime(state) !== shownTime(before)) {
          later();
        }
      }),
    [later],
  );
  return lost === null ? (
    <>
      <canvas ref={canvas} className="activity-strip" aria-hidden />
      <span ref={value} className="activity-value fine" />
    </>
  ) : (
    <span className="activity-lost fine">{lost.what}</span>
  );
}

// Samples until here are shown; after a reset those of the run before are later. Their times are rounded.
function shownTime({ clock }: Studio): number {
  return clock === null ? Infinity : (clock.timeline?.time ?? clock.time) + clock.dt / 2;
}

const PACE_MS = 100;
