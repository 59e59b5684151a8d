// The tab of a panel: its title, and a cross for the mouse. The key Delete closes the panel, too.

import { IconX } from "@tabler/icons-react";
import type { IDockviewPanelHeaderProps } from "dockview-react";
import { useEffect, useState } from "react";

export function PanelTab({ api }: IDockviewPanelHeaderProps) {
  const [title, setTitle] = useState(api.title);
  useEffect(() => {
    setTitle(api.title);
    const watch = api.onDidTitleChange((changed) => setTitle(changed.title));
    return () => watch.dispose();
  }, [api]);
  return (
    <div className="dv-default-tab">
      <span className="dv-default-tab-content">{title}</span>
      {/* A tab may not contain a button: screen readers do not reach it. */}
      <span
        className="dv-default-tab-action"
        aria-hidden="true"
        title="Close (Delete)"
        onPointerDown={(event) => event.preventDefault()}
        onClick={(event) => {
          event.stopPropagation();
          api.close();
        }}
      >
        <IconX size={13} stroke={1.6} />
      </span>
    </div>
  );
}
