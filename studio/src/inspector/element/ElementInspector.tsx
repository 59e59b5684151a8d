// One element: its kind, its equation and its parameters.

import { UnstyledButton } from "@mantine/core";

import type { ElementView, Kind } from "../../protocol";
import { useStudio } from "../../server/store";
import { Tex } from "../../widgets/Tex";
import { Fields } from "../../forms/PartFields";
import { useAxes } from "../../state/place";
import { ElementPlace } from "../../forms/ElementPlace";
import { PortTable } from "./PortTable";
import { ProblemBanner } from "../../problems/ProblemBanner";
import { sectionsOf, titleOf } from "./sections";

export function ElementInspector({ id }: { id: string }) {
  const element = useStudio((state) => state.elements.get(id));
  const kind = useStudio((state) => state.kinds.get(element?.kind ?? ""));
  const { axes } = useAxes();
  if (element === undefined) {
    return <div className="inspector-empty dim">This element was removed.</div>;
  }
  const sections = sectionsOf(kind?.parameters ?? []);
  return (
    <ElementPlace id={id}>
      <Header element={element} kind={kind} />
      <ProblemBanner element={id} />
      {kind === undefined ? (
        <p className="dim">Nothing is known of the kind {element.kind}.</p>
      ) : (
        <>
          <section className="equation" aria-label="Equation">
            {kind.equation.map((line) => (
              <div className="equation-line" key={line} tabIndex={-1}>
                <Tex source={line} block />
              </div>
            ))}
            {kind.reference !== "" && <p className="reference fine">{kind.reference}</p>}
          </section>
          {sections.map(({ section, forms }) => (
            <section key={section} className="parameters" aria-label={titleOf(section)}>
              {sections.length > 1 && section !== "" && <h3>{titleOf(section)}</h3>}
              <Fields forms={forms} values={element.values} prefix="" />
            </section>
          ))}
          {sections.length === 0 && <p className="dim">This element has no parameters.</p>}
          <PortTable element={element} kind={kind} axes={axes} />
        </>
      )}
    </ElementPlace>
  );
}

function Header({ element, kind }: { element: ElementView; kind: Kind | undefined }) {
  const select = useStudio((state) => state.select);
  return (
    <header className="inspector-header">
      <nav className="inspector-path fine" aria-label="Path of the element">
        <UnstyledButton className="to-document" onClick={() => select([])}>
          Document
        </UnstyledButton>
        {element.group.map((group, i) => (
          <span className="one-line" key={i} title={group}>
            / {group}
          </span>
        ))}
      </nav>
      <h2 className="one-line" title={element.path}>
        {element.name}
      </h2>
      <span className="kind-title">{kind?.title ?? element.kind}</span>
      {element.every > 1 && <span className="dim">runs every {element.every} steps</span>}
    </header>
  );
}
