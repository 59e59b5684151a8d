// One element: its kind, its equation and its parameters.

import type { AxisView } from "../../protocol";
import { useStudio } from "../../store";
import { ElementHeader } from "./ElementHeader";
import { ElementPlace } from "./ElementPlace";
import { Equation } from "./Equation";
import { ParameterSections } from "./ParameterSections";
import { PortTable } from "./PortTable";
import { ProblemBanner } from "./ProblemBanner";

const NO_AXES: AxisView[] = [];

export function ElementInspector({ id }: { id: string }) {
  const element = useStudio((state) => state.elements.get(id));
  const kind = useStudio((state) => state.kinds.get(element?.kind ?? ""));
  const axes = useStudio((state) => state.document?.axes) ?? NO_AXES;
  if (element === undefined) {
    return <div className="inspector-empty">This element was removed.</div>;
  }
  return (
    <ElementPlace id={id}>
      <ElementHeader element={element} kind={kind} />
      <ProblemBanner element={id} />
      {kind === undefined ? (
        <p className="dim">Nothing is known of the kind {element.kind}.</p>
      ) : (
        <>
          <Equation lines={kind.equation} reference={kind.reference} />
          <ParameterSections kind={kind} values={element.values} />
          {kind.parameters.length === 0 && <p className="dim">This element has no parameters.</p>}
          <PortTable element={element} kind={kind} axes={axes} />
        </>
      )}
    </ElementPlace>
  );
}
