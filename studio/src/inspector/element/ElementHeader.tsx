// Name, path and kind of an element.

import { UnstyledButton } from "@mantine/core";

import type { ElementView, Kind } from "../../protocol";
import { useStudio } from "../../store";

export function ElementHeader({ element, kind }: { element: ElementView; kind: Kind | undefined }) {
  const select = useStudio((state) => state.select);
  return (
    <header className="inspector-header">
      <nav className="inspector-path" aria-label="Path of the element">
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
