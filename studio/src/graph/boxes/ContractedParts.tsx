// The elements that a box of a contracted architecture shows inside: a dot for each stimulus that it
// receives, a ring for each coupling with itself.

import { useStudio } from "../../server/store";
import { useHover } from "../../state/hover";
import { pressing } from "../../actions/pressing";
import { useProblem } from "../../state/problem";

type Props = { dots: string[]; badges: string[] };

export function Parts({ dots, badges }: Props) {
  return dots.length + badges.length === 0 ? null : (
    <div className="graph-parts">
      {dots.map((id) => (
        <Part key={id} element={id} look="dot" />
      ))}
      {badges.map((id) => (
        <Part key={id} element={id} look="ring" />
      ))}
    </div>
  );
}

function Part({ element: id, look }: { element: string; look: "dot" | "ring" }) {
  const path = useStudio((state) => state.elements.get(id)?.path ?? "");
  const effect = useStudio((state) => state.elements.get(id)?.effect);
  const selected = useStudio((state) => state.selected.includes(id));
  const problem = useProblem(id);
  const { enter, leave } = useHover.getState();
  return (
    <button
      type="button"
      className="graph-part nodrag nopan"
      data-element={id}
      data-look={look}
      data-sign={effect}
      data-problem={problem !== "" || undefined}
      title={path}
      aria-label={look === "dot" ? path : `${path}, on itself`}
      aria-pressed={selected}
      {...pressing(id)}
      onPointerEnter={(event) => {
        event.stopPropagation();
        enter(id, event.currentTarget);
      }}
      onPointerLeave={leave}
    />
  );
}
