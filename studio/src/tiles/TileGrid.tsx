// The plots of a view as tiles of a grid: a row below the centre, or all of the centre in Run.

import { IconArrowsDiagonal, IconArrowsDiagonalMinimize, IconX } from "@tabler/icons-react";
import {
  type CSSProperties,
  type KeyboardEvent,
  type PointerEvent,
  useEffect,
  useRef,
  useState,
} from "react";
import { usePage, type View } from "../state/page";
import { moveTile, removeTile, type PlotTile, settleTiles, tilesIn, useTiles } from "../state/tiles";
import { IconButton } from "../widgets/Buttons";
import { useVisible } from "../widgets/useVisible";
import { useWidth } from "../widgets/useWidth";
import { NARROW } from "../actions/openPlot";
import { PlotPanel } from "./PlotPanel";
import classes from "./TileGrid.module.css";

// What Escape closes or takes back itself.
const OWN_ESCAPE = "input, textarea, select, [role=dialog], [role=menu], [role=listbox]";
const LEAST_WIDTH = 300;
const ROW = { wide: 3, narrow: 2, from: 1280 };

// Columns of a grid of this width in px: as few rows as it allows, and these as even as possible.
export function columnsOf(width: number, count: number): number {
  const most = Math.max(1, Math.floor(width / LEAST_WIDTH));
  return Math.ceil(count / Math.ceil(count / most)) || 1;
}

export function TileGrid() {
  const view = usePage((page) => page.view);
  const tiles = useTiles((state) => tilesIn(state, view));
  // a plot that was closed leaves the others as they were
  const enlarged = usePage((page) => tiles.find(({ key }) => key === page.enlarged)?.key ?? null);
  const grid = useRef<HTMLDivElement>(null);
  const width = useWidth(grid);
  useEffect(() => {
    const back = (event: globalThis.KeyboardEvent) => {
      const elsewhere = event.target instanceof Element && event.target.closest(OWN_ESCAPE) !== null;
      if (event.key === "Escape" && !event.defaultPrevented && !elsewhere) {
        usePage.setState({ enlarged: null });
      }
    };
    addEventListener("keydown", back);
    return () => removeEventListener("keydown", back);
  }, []);
  const inRow = Math.min(tiles.length, innerWidth >= ROW.from ? ROW.wide : ROW.narrow);
  const columns = view === "run" || matchMedia(NARROW).matches ? columnsOf(width, tiles.length) : inRow;
  return (
    <div
      ref={grid}
      className={classes.tiles}
      data-view={view}
      data-enlarged={enlarged ?? undefined}
      style={{ "--columns": Math.max(1, columns) } as CSSProperties}
    >
      {view === "run" && tiles.length === 0 && (
        <p className="dim">
          No plot is open. Double-click a box of the architecture, or press + on the right.
        </p>
      )}
      {tiles.map((tile, i) => (
        <OneTile key={tile.key} view={view} tile={tile} place={i} enlarged={enlarged === tile.key} />
      ))}
    </div>
  );
}

type OneTileProps = { view: View; tile: PlotTile; place: number; enlarged: boolean };

function OneTile({ view, tile, place, enlarged }: OneTileProps) {
  const around = useRef<HTMLDivElement>(null);
  // A tile that is scrolled away draws nothing, but its time courses grow.
  const visible = useVisible(around, true);
  const enlarge = () => usePage.setState({ enlarged: enlarged ? null : tile.key });
  const drag = useDrag(view, tile.key);
  const key = (event: KeyboardEvent) => {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key] ?? 0;
    if (event.key === "Delete") {
      removeTile(view, tile.key);
    } else if (event.shiftKey && step !== 0) {
      moveTile(view, tile.key, place + step);
      settleTiles();
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  };
  return (
    <div
      ref={around}
      className={classes.tile}
      data-tile={tile.key}
      data-place={place}
      data-enlarged={enlarged || undefined}
      {...drag}
      onDoubleClick={(event) => isHead(event.target) && enlarge()}
    >
      <PlotPanel tile={tile} view={view} visible={visible} />
      <div className={classes.buttons} onKeyDown={key}>
        <IconButton
          icon={enlarged ? IconArrowsDiagonalMinimize : IconArrowsDiagonal}
          size={24}
          label={enlarged ? "Reduce this plot" : "Enlarge this plot"}
          tip={enlarged ? "Back to the others (Esc)" : "Enlarge (double click; Shift+arrows move the plot)"}
          onClick={enlarge}
        />
        <IconButton
          icon={IconX}
          size={24}
          label="Close this plot"
          tip="Close (Delete)"
          onClick={() => removeTile(view, tile.key)}
        />
      </div>
    </div>
  );
}

// The line of names of a plot, apart from its controls.
const isHead = (target: EventTarget): boolean =>
  target instanceof Element &&
  target.closest(".plot-head") !== null &&
  target.closest("button, select, input, [role=menu]") === null;

// A tile that is dragged by its head takes the place of the one below the pointer. The page listens, because
// a tile that moves in the document would lose the pointer.
function useDrag(view: View, key: number) {
  const [dragging, setDragging] = useState(false);
  const onPointerDown = (down: PointerEvent) => {
    if (down.button !== 0 || !isHead(down.target)) {
      return;
    }
    const move = ({ clientX: x, clientY: y }: globalThis.PointerEvent) => {
      if (Math.hypot(x - down.clientX, y - down.clientY) < 6) {
        return;
      }
      setDragging(true);
      const over = document.elementFromPoint(x, y)?.closest<HTMLElement>("[data-tile]");
      if (over != null && over.dataset["tile"] !== String(key)) {
        moveTile(view, key, Number(over.dataset["place"]));
      }
    };
    const listening = new AbortController();
    const end = () => {
      listening.abort();
      setDragging(false);
      settleTiles();
    };
    addEventListener("pointermove", move, listening);
    addEventListener("pointerup", end, listening);
    addEventListener("pointercancel", end, listening);
  };
  return { "data-dragging": dragging || undefined, onPointerDown };
}
