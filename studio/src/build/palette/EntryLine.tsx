// One line of a list: the sketch of a kind or the picture of a template, its title, and why it cannot be
// chosen, if so.

import { carriedBy, carry } from "../wiring/carried";
import type { ListEntry } from "./entries";
import { Sketch, TemplatePicture } from "./Sketch";

type Props = {
  id: string;
  entry: ListEntry;
  active: boolean;
  draggable: boolean;
  onLook: () => void;
  onChoose: () => void;
};

export function EntryLine({ id, entry, active, draggable, onLook, onChoose }: Props) {
  const { title, note, why, kind, template } = entry;
  const carried = draggable ? carriedBy(entry) : null;
  return (
    <div
      id={id}
      className="across chooser-entry"
      role="option"
      tabIndex={-1}
      aria-selected={active}
      aria-disabled={why !== undefined}
      title={why}
      draggable={carried !== null}
      onDragStart={(event) => {
        const now = carriedBy(entry); // its values follow from the document as it is now
        return now !== null && carry(event.dataTransfer, now);
      }}
      onPointerMove={() => !active && why === undefined && onLook()}
      // the text field keeps the focus
      onPointerDown={(event) => carried === null && event.preventDefault()}
      onClick={onChoose}
      onKeyDown={(event) => event.key === "Enter" && onChoose()}
    >
      {kind !== undefined && <Sketch kind={kind} />}
      {template !== undefined && <TemplatePicture template={template} className="chooser-thumbnail" />}
      <span className="down grow">
        <span className="one-line">{title}</span>
        {why !== undefined && <span className="dim one-line chooser-note">{why}</span>}
      </span>
      {note !== undefined && <span className="dim one-line chooser-note">{note}</span>}
    </div>
  );
}
