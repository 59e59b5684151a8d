// A coupling on an edge: its name and the number it is known by.

import { useStudio } from "../../store";
import { mainNumber } from "./facts";
import { useHover } from "../hover";
import { labelOf } from "./label";
import { MarkIcon } from "./Mark";
import { pressing } from "./pressing";
import { useProblem, useWarning } from "../problem";

export function Pill({ element: id }: { element: string }) {
  const path = useStudio((state) => state.elements.get(id)?.path ?? "");
  const label = useStudio(({ elements, kinds }) => {
    const { name = "", kind = "" } = elements.get(id) ?? {};
    return labelOf(name, kind, kinds.get(kind)?.title ?? "");
  });
  const selected = useStudio((state) => state.selected.includes(id));
  const problem = useProblem(id);
  const warning = useWarning(id);
  const said = problem !== "" ? problem : warning !== "" ? `Warning: ${warning}` : "";
  const number = useStudio(({ elements, kinds, document }) => {
    const element = elements.get(id);
    return element === undefined || document === null
      ? ""
      : mainNumber(element, kinds.get(element.kind), document);
  });
  const { enter, leave } = useHover.getState();
  return (
    <button
      type="button"
      className="graph-pill nodrag nopan"
      data-element={id}
      data-selected={selected || undefined}
      data-problem={problem !== "" || undefined}
      title={said || undefined}
      aria-label={[path, path.endsWith(label) ? "" : label, number, said]
        .filter((part) => part !== "")
        .join(", ")}
      aria-pressed={selected}
      {...pressing(id)}
      onPointerEnter={(event) => enter(id, event.currentTarget)}
      onPointerLeave={leave}
    >
      {said !== "" && <MarkIcon problem={problem !== ""} size={12} />}
      <span className="one-line">{label}</span> {number !== "" && <b className="numbers">{number}</b>}
    </button>
  );
}
