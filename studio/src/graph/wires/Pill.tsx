// A coupling on an edge: its name and the number it is known by.

import { useStudio } from "../../server/store";
import { mainNumber } from "../../model/facts";
import { useHover } from "../../state/hover";
import { labelOf } from "../../architecture/label";
import { MarkIcon } from "../../problems/Mark";
import { pressing } from "../../actions/pressing";
import { useProblem, useWarning } from "../../state/problem";
import { numberAt, useNumber } from "../../actions/strength";
import { StrengthControl } from "./StrengthControl";

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
  const strength = useStudio((state) => state.elements.get(id)?.strength ?? "");
  const { enter, leave } = useHover.getState();
  return (
    <div
      className="graph-pill"
      data-element={id}
      data-selected={selected || undefined}
      data-problem={problem !== "" || undefined}
    >
      <button
        type="button"
        className="graph-pill-name nodrag nopan"
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
        <span className="one-line">{label}</span>{" "}
        {number !== "" && strength === "" && <b className="numbers">{number}</b>}
      </button>
      {strength !== "" && <PillStrength element={id} path={strength} />}
    </div>
  );
}

function PillStrength({ element, path }: { element: string; path: string }) {
  const stored = useStudio(({ elements, document }) => {
    const known = elements.get(element);
    return known === undefined || document === null ? 0 : (numberAt(known, path, document) ?? 0);
  });
  const label = useStudio(({ elements }) => `Strength of ${elements.get(element)?.path ?? ""}`);
  const select = () => useStudio.getState().select([element]);
  return <StrengthControl label={label} setting={useNumber(element, path, stored)} onClick={select} />;
}
