// What the pointer does with ports and connections, as properties of the canvas.

import { type Edge, type ReactFlowProps, useStoreApi } from "@xyflow/react";
import { useEffect, useMemo } from "react";

import { overWire, useFocus } from "../actions/focus";
import { useHover } from "../state/hover";
import type { SceneNode, Wire } from "../architecture/nodes";
import { useStudio } from "../server/store";
import { finish } from "../actions/connecting";
import { openPalette } from "../actions/palette";
import { pickWire, usePicked } from "../actions/picked";
import { endAt, type WireEnds } from "../model/ends";
import { endOf } from "../actions/wires";
import { begin, end, fitOf, stateOf, useWiring } from "../actions/wiring";

type Props = ReactFlowProps<SceneNode, Edge>;

// Within this many pixels of a port a connection ends at it.
const RADIUS = 24;

// The ends of connections that are selected or below the pointer can be moved.
function useMovable(wires: Wire[], editable: boolean, near: string | null): Edge[] {
  const picked = usePicked((state) => state.wires);
  return useMemo(
    () =>
      wires.map((wire) =>
        editable && (wire.id === near || picked.includes(wire.id)) && wire.data?.chains.length === 1
          ? { ...wire, reconnectable: true }
          : wire,
      ) as Edge[],
    [wires, editable, near, picked],
  );
}

export function useWires(wires: Wire[]): Props {
  const flow = useStoreApi();
  const near = useFocus((state) => state.wire);
  const editable = useStudio((state) => state.document?.record == null && state.connection === "open");
  useEffect(() => {
    const onKey = (event: KeyboardEvent) => {
      if (event.key === "Escape" && useWiring.getState().wiring !== null) {
        flow.setState({ connectionClickStartHandle: null });
        end();
      }
    };
    addEventListener("keydown", onKey);
    return () => removeEventListener("keydown", onKey);
  }, [flow]);
  const edges = useMovable(wires, editable, near);
  const props = useMemo((): Props => {
    // xyflow calls onReconnectStart just before onConnectStart
    let moved: WireEnds | null = null;
    const start: Props["onConnectStart"] = (_, { nodeId, handleId, handleType }) => {
      if (moved !== null && handleType !== null) {
        const fixed = handleType === "source";
        const from = fixed
          ? { element: moved.source, port: moved.source_port }
          : { element: moved.target, port: moved.target_port };
        useHover.getState().close();
        void begin(from, handleType, moved);
        moved = null;
      } else if (nodeId !== null && handleId !== null && handleType !== null) {
        const { element, port } = endAt(nodeId, handleId);
        useHover.getState().close();
        void begin({ element, port: port ?? "" }, handleType);
      }
    };
    const stop: Props["onConnectEnd"] = (event, { toHandle }) => {
      const { clientX: x, clientY: y } =
        "changedTouches" in event ? (event.changedTouches[0] as Touch) : event;
      const to = toHandle === null ? elementAt(x, y) : endAt(toHandle.nodeId, toHandle.id ?? null);
      if (to === "outside") {
        end();
      } else {
        void finish({ x, y }, to);
      }
    };
    return {
      nodesConnectable: editable,
      connectionRadius: RADIUS,
      onConnectStart: start,
      onConnectEnd: stop,
      onReconnectStart: (_, { id }, fixed) => {
        moved = endOf(id, fixed === "source" ? "target" : "source");
      },
      // onConnectEnd moves the end
      onReconnect: () => {},
      onEdgeMouseEnter: (_, { id }) => useWiring.getState().wiring === null && overWire(id),
      onEdgeMouseLeave: () => useWiring.getState().wiring === null && overWire(null),
      onClickConnectStart: start,
      onClickConnectEnd: stop,
      isValidConnection: ({ source, sourceHandle, target, targetHandle }) => {
        const { wiring } = useWiring.getState();
        const [node, handle] = wiring?.side === "source" ? [target, targetHandle] : [source, sourceHandle];
        const { element, port } = endAt(node, handle ?? null);
        const fit = wiring?.fits == null ? undefined : fitOf(wiring.fits, element, port);
        return fit !== undefined && stateOf(fit) !== "no";
      },
      // a click at a port, and then one on the ground
      onPaneClick: ({ clientX: x, clientY: y }) => {
        if (useWiring.getState().wiring !== null) {
          flow.setState({ connectionClickStartHandle: null });
          void finish({ x, y }, null);
        } else {
          useStudio.getState().select([]);
        }
      },
      onPaneContextMenu: (event) => {
        event.preventDefault();
        openPalette({ x: event.clientX, y: event.clientY });
      },
      onEdgeClick: (event, { id }) => pickWire(id, event.shiftKey || event.ctrlKey || event.metaKey),
      onEdgeDoubleClick: ({ clientX: x, clientY: y }, { id }) => openPalette({ x, y }, id),
      onEdgeContextMenu: (event, { id }) => {
        event.preventDefault();
        openPalette({ x: event.clientX, y: event.clientY }, id);
      },
    };
  }, [flow, editable]);
  return { ...props, edges };
}

// The element at a position of the screen, null on the ground of the canvas.
function elementAt(x: number, y: number): { element: string; port: null } | null | "outside" {
  const found = document.elementFromPoint(x, y);
  const box = found?.closest(".react-flow__node-box")?.getAttribute("data-id");
  if (box != null) {
    return { element: box, port: null };
  }
  return found?.closest(".react-flow") == null || found.closest(".react-flow__node-folded") !== null
    ? "outside"
    : null;
}
