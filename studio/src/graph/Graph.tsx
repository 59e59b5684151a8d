// The architecture on a canvas.

import {
  Background,
  BackgroundVariant,
  MiniMap,
  ReactFlow,
  ReactFlowProvider,
  useReactFlow,
  getViewportForBounds,
  useStoreApi,
  type Edge,
  type EdgeTypes,
  type NodeTypes,
  type ReactFlowProps,
} from "@xyflow/react";
import "@xyflow/react/dist/base.css";
import { useCallback, useEffect, useMemo, useRef, useState } from "react";
import { copyDragged } from "../actions/dragging";
import { insertDropped, markWire } from "../actions/inserting";
import { RenameBox } from "./RenameBox";
import { openSearch, openSelectionCommands } from "../commands/commands";
import { pickGroup, usePicked } from "../actions/picked";
import { dropIntoGroup, markGroup } from "../actions/regrouping";
import { renameSelected } from "../actions/renaming";
import { getStage } from "../actions/stage";
import { useStage } from "./useStage";
import { useWires } from "./useWires";
import { WiringHint } from "./WiringHint";
import { openPlot } from "../actions/openPlot";
import { useDialogs } from "../state/questions";
import { SHORTCUTS } from "../commands/shortcuts";
import type { Answer } from "../protocol";
import { useOffline } from "../widgets/NeedsServer";
import { useStudio } from "../server/store";
import { contractionIn } from "../architecture/contract";
import { place, showEvery, toGrid, unfold } from "../actions/arrange";
import { Box } from "./boxes/Box";
import { CellFrames } from "./boxes/CellFrames";
import { ElementCard } from "./boxes/ElementCard";
import { CommentBox } from "./boxes/CommentBox";
import { Controls, GLIDE_MS } from "./Controls";
import { withCourses } from "../architecture/courses";
import { EmptyHint } from "./EmptyHint";
import { Folded } from "./boxes/Folded";
import { GroupFrame } from "./boxes/GroupFrame";
import { FIT, ZOOM } from "../architecture/fit";
import { tidied } from "../architecture/folding";
import { glide } from "./glide";
import "./graph.css";
import { useNear } from "../actions/focus";
import { useHover } from "../state/hover";
import { moved } from "../architecture/moved";
import { MovedView } from "./boxes/movedView";
import { newPainting, PainterContext } from "./boxes/PainterContext";
import { foldedAround, foldedOutside, groupKey, type GraphScene } from "../architecture/scene";
import type { SceneNode } from "../architecture/nodes";
import type { Structure } from "../architecture/contract";
import { SignMarks } from "./wires/SignMarks";
import type { Tree } from "../architecture/tree";
import { useStructure } from "../architecture/structure";
import { useAnchor } from "./useAnchor";
import { useNodes } from "./useNodes";
import { useStart } from "./useStart";
import { useZoomLook } from "./boxes/useZoomLook";
import { WireEdge } from "./wires/WireEdge";

const NODES: NodeTypes = { box: Box, frame: GroupFrame, folded: Folded, comment: CommentBox };
const EDGES: EdgeTypes = { wire: WireEdge };
// Painting dots costs a browser without a graphics card as much as a hundred boxes do.
const MOST_DOTTED = 60;
// Up to this number all boxes stay mounted: to add and remove them while the view is moved costs more.
const MOST_MOUNTED = 1000;
const MAP = { width: 150, height: 96 };
const MULTI = ["Shift", "Meta", "Control"];

export function Graph() {
  const structure = useStructure();
  const session = useStudio((state) => state.session);
  if (structure === null) {
    return <div className="graph" />;
  }
  return (
    <ReactFlowProvider key={session}>
      <Canvas structure={structure} />
    </ReactFlowProvider>
  );
}

function Canvas({ structure }: { structure: Structure }) {
  const kinds = useStudio((state) => state.kinds);
  const offline = useOffline();
  const leaving = usePicked((state) => state.into === "");
  const around = useRef<HTMLDivElement>(null);
  const { now, touch, showAll } = useStart(structure, kinds, around);
  const { nodes, onNodesChange, settle, forgetKeys, reset } = useNodes(now, structure.layout);
  const [painting] = useState(newPainting);
  const { painter, layer } = painting;
  const { center, centerGroup } = useCenter(now);
  const shown = useCallback((canvas: HTMLCanvasElement) => layer.attach(canvas), [layer]);
  const repaint = useCallback(() => layer.change(), [layer]);
  useEffect(repaint, [repaint, nodes]);
  useNear(now, repaint);
  const flow = useReactFlow<SceneNode>();
  const views = useStoreApi();
  const [view] = useState(
    () =>
      new MovedView(
        ({ x, y, zoom }) => {
          const picture = around.current?.querySelector<HTMLElement>(".react-flow__viewport");
          picture?.style.setProperty("transform", `translate(${x}px,${y}px) scale(${zoom})`);
        },
        ({ x, y, zoom }) => views.setState({ transform: [x, y, zoom] }),
      ),
  );
  // Every change of the view, also one that the page makes itself.
  useEffect(
    () => views.subscribe(({ transform }, before) => transform !== before.transform && layer.change()),
    [views, layer],
  );
  const contraction = useMemo(() => contractionIn(structure, kinds), [structure, kinds]);
  const arranged = useCallback(
    async (answer: Promise<Answer>) => {
      const { problems = [] } = await answer;
      if (problems.length === 0) {
        requestAnimationFrame(() => showAll(glide(GLIDE_MS)));
      }
    },
    [showAll],
  );
  const every = contraction === null ? null : structure.layout.every_element;
  const tidy = () => void arranged(every === false ? toGrid() : place(tidied(structure, kinds)));
  const stage = useStage(
    around,
    now,
    (element) => {
      touch();
      useStudio.getState().select([element]);
      center(element);
    },
    (group) => {
      touch();
      pickGroup(group, false);
      centerGroup(group);
    },
    showAll,
    tidy,
  );
  const wiring = useWires(useMemo(() => withCourses(now), [now]));
  // The first element of an empty document stays where it was put.
  const [fits] = useState(now.nodes.length > 0);
  useZoomLook(around, nodes, view);
  useAnchor(now);

  useEffect(() => {
    const key = (event: KeyboardEvent) => {
      const control = event.key.toLowerCase() === "f" && (event.ctrlKey || event.metaKey);
      if (!event.defaultPrevented && control && getStage() !== null && useDialogs.getState().asked === null) {
        event.preventDefault();
        openSearch();
      }
    };
    window.addEventListener("keydown", key);
    return () => window.removeEventListener("keydown", key);
  }, []);

  // While the canvas is moved it is one layer that the browser only shifts: live boxes are painted about once
  // a second.
  const move = useCallback(
    (moving: boolean, byHand: boolean) => {
      view.hold(moving && byHand);
      useHover.getState().close();
      painter.hold(moving);
      layer.move(moving ? flow.getViewport() : null);
      around.current?.toggleAttribute("data-moving", moving);
    },
    [view, painter, layer, flow],
  );

  // The same functions throughout: for each new one xyflow asks all boxes and wires.
  const handlers = useMemo(
    (): ReactFlowProps<SceneNode, Edge> => ({
      onNodeDragStart: () => {
        useHover.getState().close();
        forgetKeys();
      },
      onNodeDragStop: (event, { id }, dragged) => {
        const nodes = flow.getNodes();
        if (event.altKey) {
          usePicked.setState({ over: null, into: null });
          copyDragged(nodes);
          reset();
          return;
        }
        const boxes = moved(nodes, now.tree, now.places);
        const changed = insertDropped(id, boxes) ?? dropIntoGroup(dragged, boxes);
        if (changed === null) {
          settle();
        } else {
          forgetKeys();
          void changed.then((done) => !done && reset());
        }
      },
      onNodeContextMenu: (event, { id, type }) => {
        event.preventDefault();
        const element = partBelow(event.target) ?? id;
        if (type === "box" && !useStudio.getState().selected.includes(element)) {
          useStudio.getState().select([element]);
        } else if (type === "frame" || type === "folded") {
          pickGroup(groupKey(id), false);
        } else if (type === "comment") {
          return;
        }
        openSelectionCommands({ x: event.clientX, y: event.clientY }, SHORTCUTS);
      },
      onNodeClick: (event, { id, type }) => {
        useHover.getState().close();
        const several = event.shiftKey || event.ctrlKey || event.metaKey;
        if (type === "frame" || type === "folded") {
          pickGroup(groupKey(id), several);
        } else if (type === "box" && !several) {
          // xyflow leaves several selected boxes as they are
          useStudio.getState().select([id]);
        }
      },
      onNodeDoubleClick: (_, { id, type }) => {
        if (type === "box") {
          openPlot({ element: id });
        } else if (type === "frame") {
          renameSelected();
        }
      },
      onNodeDrag: (event, node, dragged) => {
        layer.change();
        markWire(event, dragged);
        markGroup(event, node, dragged);
      },
      onMoveStart: (event) => move(true, event !== null),
      onMove: (_, view) => layer.move(view),
      onMoveEnd: () => {
        view.hold(false);
        view.atRest(() => move(false, false));
      },
    }),
    [view, flow, now, layer, move, settle, forgetKeys, reset],
  );

  return (
    <PainterContext value={painting}>
      <div
        className="graph"
        data-into={leaving || undefined}
        ref={around}
        {...stage}
        onPointerDownCapture={() => {
          view.flush();
          touch();
        }}
        onWheelCapture={touch}
        onKeyDownCapture={touch}
      >
        <ReactFlow<SceneNode, Edge>
          nodes={nodes}
          nodeTypes={NODES}
          edgeTypes={EDGES}
          onNodesChange={onNodesChange}
          nodesDraggable={!offline}
          nodesConnectable={!offline}
          {...handlers}
          {...wiring}
          viewport={view.now}
          onViewportChange={view.change}
          onlyRenderVisibleElements={nodes.length > MOST_MOUNTED}
          edgesFocusable={false}
          zIndexMode="manual"
          elevateNodesOnSelect={false}
          deleteKeyCode={null}
          multiSelectionKeyCode={MULTI}
          zoomOnDoubleClick={false}
          minZoom={ZOOM.min}
          maxZoom={ZOOM.max}
          fitView={fits}
          fitViewOptions={FIT}
        >
          {nodes.length <= MOST_DOTTED && (
            <Background variant={BackgroundVariant.Dots} gap={22} size={1.4} color="var(--line)" />
          )}
          <CellFrames frames={now.frames} />
          <canvas ref={shown} className="graph-live-layer" aria-hidden />
          <MiniMap
            style={MAP}
            pannable
            zoomable
            ariaLabel="Overview of the canvas"
            nodeStrokeWidth={0}
            nodeBorderRadius={4}
            nodeClassName={miniClass}
          />
        </ReactFlow>
        {nodes.length === 0 && <EmptyHint />}
        <Controls
          onShow={() => showAll(glide(GLIDE_MS))}
          onTidy={tidy}
          every={every}
          onEvery={(shown) => void arranged(showEvery(shown, contraction?.couplings ?? new Set()))}
        />
        <SignMarks />
        <ElementCard />
        <WiringHint />
        <RenameBox />
      </div>
    </PainterContext>
  );
}

// Brings an element, or all of a group, into the middle; folded groups around it are opened first.
function useCenter(now: GraphScene): Record<"center" | "centerGroup", (id: string) => void> {
  const { getNodesBounds, setCenter, setViewport, getZoom } = useReactFlow();
  const views = useStoreApi();
  const [wanted, setWanted] = useState<{ id: string; isGroup: boolean } | null>(null);
  useEffect(() => {
    if (wanted === null || foldedOver(now.tree, wanted).length > 0) {
      return;
    }
    setWanted(null);
    const [zoom, duration] = [Math.max(getZoom(), 0.8), glide(GLIDE_MS)];
    if (wanted.isGroup) {
      const group = now.places.groups.get(wanted.id);
      const { width, height } = views.getState();
      if (group !== undefined) {
        void setViewport(getViewportForBounds(group, width, height, ZOOM.min, zoom, 0.1), { duration });
      }
      return;
    }
    const wire = now.wires.find(({ id }) => id === now.pills.get(wanted.id));
    const box = now.holders.get(wanted.id) ?? wanted.id;
    const { x, y, width, height } = getNodesBounds(wire === undefined ? [box] : [wire.source, wire.target]);
    void setCenter(x + width / 2, y + height / 2, { zoom, duration });
  }, [wanted, now, views, getNodesBounds, setCenter, setViewport, getZoom]);
  const want = (id: string, isGroup: boolean) => {
    const folded = foldedOver(now.tree, { id, isGroup });
    if (folded.length > 0) {
      unfold(folded);
    }
    setWanted({ id, isGroup });
  };
  return { center: (element) => want(element, false), centerGroup: (group) => want(group, true) };
}

// The element that a box shows inside, at the pointer.
const partBelow = (target: EventTarget): string | null =>
  target instanceof Element ? (target.closest(".graph-part")?.getAttribute("data-element") ?? null) : null;

const foldedOver = (found: Tree, { id, isGroup }: { id: string; isGroup: boolean }): string[] =>
  isGroup ? foldedOutside(found, id) : foldedAround(found, id);

function miniClass({ type }: SceneNode): string {
  return `graph-mini-${type}`;
}
