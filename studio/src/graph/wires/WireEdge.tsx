// A connection on the canvas, with the couplings that are drawn on it.

import { BaseEdge, EdgeLabelRenderer, type EdgeProps } from "@xyflow/react";
import { type CSSProperties, memo } from "react";
import { pickWire, usePicked } from "../../actions/picked";
import { useStudio } from "../../server/store";
import { overWire, useFocus } from "../../actions/focus";
import { useProblem } from "../../state/problem";
import { Pill } from "./Pill";
import { markOf } from "./SignMarks";
import type { Point } from "../../model/rects";
import type { Wire } from "../../architecture/nodes";
import type { Chain } from "../../architecture/chains";
import { StrengthControl } from "./StrengthControl";
import { hasOwn, strengthOf, useStrength, widthOf, wireText } from "../../actions/strength";
import { WireCard } from "./WireCard";
import { type Course, direct } from "../../architecture/wirePath";

export const WireEdge = memo(function WireEdge(props: EdgeProps<Wire>) {
  const { id, source, target, sourceX, sourceY, targetX, targetY, data } = props;
  const touched = useStudio(
    ({ selected }) =>
      selected.includes(source) ||
      selected.includes(target) ||
      (data?.pills.some((p) => selected.includes(p)) ?? false),
  );
  const revealed = useStudio(({ selected }) => data?.revealed.some((p) => selected.includes(p)) ?? false);
  const hovered = useFocus((state) => state.hovered === source || state.hovered === target);
  const picked = usePicked((state) => state.wires.includes(id));
  const alone = usePicked((state) => state.wires.length === 1 && state.wires[0] === id);
  const over = usePicked((state) => state.over === id);
  const chain = data?.chains.length === 1 ? data.chains[0] : undefined;
  const strength = useStudio((state) => (chain === undefined ? null : strengthOf(chain, state)));
  const isOwn = useStudio((state) => chain !== undefined && hasOwn(chain, state.elements));
  const near = useFocus((state) => state.wire === id || state.changed === id);
  if (data === undefined) {
    return null;
  }
  const { path, middle } = courseNow(data.course, { x: sourceX, y: sourceY }, { x: targetX, y: targetY });
  const several = data.count > 1;
  const contracted = data.content !== null;
  const pills = data.pills.filter((pill) => pill !== chain?.gain);
  const shown = contracted ? touched || picked : data.pills.length > 0 || several;
  const isListed = !contracted || picked || revealed || pills.length === 0;
  const hasNumber = isOwn && isListed && (near || picked || (shown && chain?.gain != null));
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
        data-touched={touched || (contracted && hovered) || undefined}
        data-faint={contracted || undefined}
        data-picked={picked || over || undefined}
        style={strength === null ? undefined : ({ "--wire-width": widthOf(strength) } as CSSProperties)}
      />
      {(hasNumber || (shown && (pills.length > 0 || several))) && (
        <EdgeLabelRenderer>
          <div
            className="graph-pills"
            data-listed={contracted || undefined}
            style={{ transform: `translate(-50%, -50%) translate(${middle.x}px, ${middle.y}px)` }}
            onPointerEnter={() => overWire(id)}
            onPointerLeave={() => overWire(null)}
            onFocus={() => useFocus.setState({ changed: id })}
            onBlur={() => useFocus.setState({ changed: null })}
          >
            {alone && <WireCard chain={chain} count={data.count} />}
            {!isListed ? (
              <Chip wire={id} pills={pills} />
            ) : several ? (
              <span className="graph-count" title={`${data.count} connections`}>
                {data.count}
              </span>
            ) : (
              pills.map((pill) => <Pill key={pill} element={pill} />)
            )}
            {hasNumber && chain !== undefined && <WireStrength wire={id} chain={chain} />}
          </div>
        </EdgeLabelRenderer>
      )}
    </>
  );
});

function WireStrength({ wire, chain }: { wire: string; chain: Chain }) {
  const problem = useProblem(chain.gain ?? "");
  const label = useStudio(({ elements }) => `Strength, ${wireText(chain, elements)}`);
  return (
    <div
      className="graph-pill graph-chip-strength"
      data-element={chain.gain ?? undefined}
      data-problem={problem !== "" || undefined}
    >
      <StrengthControl label={label} setting={useStrength(chain)} onClick={() => pickWire(wire, false)} />
    </div>
  );
}

// The number of couplings on a wire of a contracted document. A click shows them, or selects a single one.
function Chip({ wire, pills }: { wire: string; pills: string[] }) {
  const names = useStudio(({ elements }) => pills.map((id) => elements.get(id)?.path ?? "").join(", "));
  const [only, ...others] = pills;
  return (
    <button
      type="button"
      className="graph-count graph-chip nodrag nopan"
      title={names}
      aria-label={`${pills.length} on the wire: ${names}`}
      onClick={(event) => {
        event.stopPropagation();
        if (only !== undefined && others.length === 0) {
          useStudio.getState().select([only]);
        } else {
          pickWire(wire, false);
        }
      }}
    >
      {pills.length}
    </button>
  );
}

// The border of a box moves its ports by less than this.
const MOVED = 3;

// While a box is dragged, only its own wires move.
function courseNow(known: Course | null, from: Point, to: Point): Course {
  return known !== null && same(known.from, from) && same(known.to, to) ? known : direct(from, to);
}

function same(a: Point, b: Point): boolean {
  return Math.abs(a.x - b.x) < MOVED && Math.abs(a.y - b.y) < MOVED;
}
