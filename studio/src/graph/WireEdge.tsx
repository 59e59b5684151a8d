// A connection on the canvas, with the couplings that are drawn on it.

import {
  BaseEdge,
  EdgeLabelRenderer,
  useInternalNode,
  useStoreApi,
  type EdgeProps,
  type InternalNode,
} from "@xyflow/react";
import { memo } from "react";
import { usePicked } from "../build/picked";
import { useStudio } from "../store";
import { Pill } from "./Pill";
import { markOf } from "./SignMarks";
import type { Rect } from "./layout";
import type { Wire } from "./scene";
import { course } from "./wirePath";

export const WireEdge = memo(function WireEdge(props: EdgeProps<Wire>) {
  const { id, source, target, sourceX, sourceY, targetX, targetY, data } = props;
  const from = useInternalNode(source);
  const to = useInternalNode(target);
  const flow = useStoreApi();
  const touched = useStudio(
    ({ selected }) =>
      selected.includes(source) ||
      selected.includes(target) ||
      (data?.pills.some((p) => selected.includes(p)) ?? false),
  );
  const picked = usePicked((state) => state.wires.includes(id));
  const over = usePicked((state) => state.over === id);
  if (from === undefined || to === undefined || data === undefined) {
    return null;
  }
  const { path, middle } = course(
    { x: sourceX, y: sourceY },
    { x: targetX, y: targetY },
    rect(from),
    rect(to),
    data.lane,
    () => boxes(flow.getState().nodeLookup),
  );
  const several = data.count > 1;
  return (
    <>
      <BaseEdge
        id={id}
        path={path}
        markerEnd={`url(#${markOf(data.sign, data.shared)})`}
        interactionWidth={24}
        className="graph-wire"
        data-reads={data.reads}
        data-sign={data.sign}
        data-touched={touched || undefined}
        data-picked={picked || over || undefined}
      />
      {(data.pills.length > 0 || several) && (
        <EdgeLabelRenderer>
          <div
            className="graph-pills"
            style={{ transform: `translate(-50%, -50%) translate(${middle.x}px, ${middle.y}px)` }}
          >
            {several ? (
              <span className="graph-count" title={`${data.count} connections`}>
                {data.count}
              </span>
            ) : (
              data.pills.map((pill) => <Pill key={pill} element={pill} />)
            )}
          </div>
        </EdgeLabelRenderer>
      )}
    </>
  );
});

function rect({ internals, measured }: InternalNode): Rect {
  return { ...internals.positionAbsolute, width: measured.width ?? 0, height: measured.height ?? 0 };
}

// Frames are no obstacle: edges lead into them. Nor is a box that is dragged: it may be dropped on the edge.
function boxes(nodes: Map<string, InternalNode>): Rect[] {
  return [...nodes.values()].filter((node) => node.type !== "frame" && node.dragging !== true).map(rect);
}
