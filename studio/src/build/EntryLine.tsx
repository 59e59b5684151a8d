// One line of a list: the sketch of a kind, its title, and why it cannot be chosen, if so.

import { carry } from "./carried";
import type { ListEntry } from "./entries";
import { Sketch } from "./Sketch";

type Props = {
  id: string;
  entry: ListEntry;
  active: boolean;
  draggable: boolean;
  onLook: () => void;
  onChoose: () => void;
};

export function EntryLine({ id, entry, active, draggable, onLook, onChoose }: Props) {
  const { title, note, why, kind } = entry;
  const carried = draggable && why === undefined ? kind : undefined;
  return (
    <div
      id={id}
      className="chooser-entry"
      role="option"
      tabIndex={-1}
      aria-selected={active}
      aria-disabled={why !== undefined}
      title={why}
      draggable={carried !== undefined}
      onDragStart={(event) => carried !== undefined && carry(event.dataTransfer, carried.name)}
      onPointerMove={() => !active && why === undefined && onLook()}
      // the text field keeps the focus
      onPointerDown={(event) => carried === undefined && event.preventDefault()}
      onClick={onChoose}
      onKeyDown={(event) => event.key === "Enter" && onChoose()}
    >
      {kind !== undefined && <Sketch kind={kind} />}
      <span className="chooser-words">
        <span className="one-line">{title}</span>
        {why !== undefined && <span className="chooser-why one-line">{why}</span>}
      </span>
      {note !== undefined && <span className="chooser-note one-line">{note}</span>}
    </div>
  );
}
