// The inspector of the selected element, of several together, or of the document without a selection.

import "./inspector.css";

import { useStudio } from "../store";
import { DocumentInspector } from "./document/DocumentInspector";
import { ElementInspector } from "./element/ElementInspector";
import { ManyInspector } from "./element/ManyInspector";

export function Inspector() {
  const selected = useStudio((state) => state.selected);
  const open = useStudio((state) => state.document !== null);
  const record = useStudio((state) => state.document?.record != null);
  const session = useStudio((state) => state.session);
  const [only] = selected;
  if (!open) {
    return <div className="inspector inspector-empty">No document is open.</div>;
  }
  return (
    // another element begins at its top: the key makes another scrolled box of it
    <div className="inspector" inert={record} key={selected.join()}>
      {record && (
        <p className="inspector-record">Parameters of the record; its model can be run and changed.</p>
      )}
      {only === undefined ? (
        <DocumentInspector key={session} />
      ) : selected.length > 1 ? (
        <ManyInspector key={selected.join()} ids={selected} />
      ) : (
        <ElementInspector key={only} id={only} />
      )}
    </div>
  );
}
