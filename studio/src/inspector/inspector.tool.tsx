// The inspector of the selected element, of several together, of a selected connection, or of the document
// without a selection.

import "../forms/inspector.css";

import { usePicked } from "../actions/picked";
import { useFocus } from "../actions/focus";
import type { DockTool } from "../state/tool";
import { useStudio } from "../server/store";
import { DocumentInspector } from "./document/DocumentInspector";
import { ElementInspector } from "./element/ElementInspector";
import { ManyInspector } from "./element/ManyInspector";
import { WireInspector } from "./wire/WireInspector";

export const tool: DockTool = {
  title: "Inspector",
  tab: 1,
  firstIn: ["build", "experiment"],
  component: Inspector,
};

function Inspector() {
  const selected = useStudio((state) => state.selected);
  const open = useStudio((state) => state.document !== null);
  const record = useStudio((state) => state.document?.record != null);
  const session = useStudio((state) => state.session);
  const [only] = selected;
  const wire = usePicked(({ wires, groups }) =>
    wires.length === 1 && groups.length === 0 ? (wires[0] ?? "") : "",
  );
  const chain = useFocus((state) => state.chains.get(wire));
  if (!open) {
    return <div className="inspector inspector-empty dim">No document is open.</div>;
  }
  return (
    // another element begins at its top: the key makes another scrolled box of it
    <div className="inspector" inert={record} key={`${selected.join()} ${wire}`}>
      {record && (
        <p className="inspector-record dim">Parameters of the record; its model can be run and changed.</p>
      )}
      {only === undefined && chain !== undefined ? (
        <WireInspector key={wire} wire={wire} chain={chain} />
      ) : only === undefined ? (
        <DocumentInspector key={session} />
      ) : selected.length > 1 ? (
        <ManyInspector key={selected.join()} ids={selected} />
      ) : (
        <ElementInspector key={only} id={only} />
      )}
    </div>
  );
}
