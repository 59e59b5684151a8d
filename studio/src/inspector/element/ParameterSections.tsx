// The parameters of a kind in sections, which follow from their declarations.

import type { Kind } from "../../protocol";
import type { Values } from "../../values";
import { Fields } from "../forms/PartFields";
import { sectionsOf, titleOf } from "./sections";

export function ParameterSections({ kind, values }: { kind: Kind; values: Values }) {
  const sections = sectionsOf(kind.parameters);
  return sections.map(({ section, forms }) => (
    <section key={section} className="parameters" aria-label={titleOf(section)}>
      {sections.length > 1 && section !== "" && <h3>{titleOf(section)}</h3>}
      <Fields forms={forms} values={values} prefix="" />
    </section>
  ));
}
