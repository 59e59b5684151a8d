// Document parameters: numbers with a name that drive parameters of elements.

import { useState } from "react";

import type { DocumentParameterView } from "../../protocol";
import { AddButton } from "../../widgets/AddButton";
import { DocumentParameterAdding } from "./DocumentParameterAdding";
import { DocumentParameterItem } from "./DocumentParameterItem";

export function DocumentParameterList({
  documentParameters,
}: {
  documentParameters: DocumentParameterView[];
}) {
  const [adding, setAdding] = useState(false);
  return (
    <section className="parameters" aria-label="Document parameters">
      <h3>
        Document parameters
        <AddButton aria-label="Add a document parameter" onClick={() => setAdding(true)} />
      </h3>
      {adding && <DocumentParameterAdding onDone={() => setAdding(false)} />}
      {documentParameters.map((documentParameter) => (
        <DocumentParameterItem key={documentParameter.name} documentParameter={documentParameter} />
      ))}
      {documentParameters.length === 0 && !adding && (
        <p className="dim hint">
          None. One document parameter can drive parameters of several elements together.
        </p>
      )}
    </section>
  );
}
