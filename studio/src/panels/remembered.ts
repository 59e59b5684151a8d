// Arrangements from before a panel was opened: when the panel is closed, the others get back their sizes.

import type { DockviewApi, SerializedDockview } from "dockview-react";

type PanelNode = { type: string; data: unknown; size?: number };
type PanelLeaf = { id: string; views: string[] };

// The arrangement `before` with the panels as they are now, if both have the same groups in the same places.
export function restored(before: SerializedDockview, now: SerializedDockview): SerializedDockview | null {
  if (structure(before.grid.root) !== structure(now.grid.root)) {
    return null;
  }
  const present = new Map(leaves(now.grid.root).map((leaf) => [leaf.id, leaf]));
  const root = replaced(before.grid.root, present) as typeof before.grid.root;
  return { ...now, grid: { ...before.grid, root } };
}

export class Remembered {
  private arrangements: SerializedDockview[] = [];
  private ends: { dispose: () => void }[] = [];

  constructor(private dock: DockviewApi) {
    this.ends = [
      // the group of the panel is removed after the event
      dock.onDidRemovePanel(() => queueMicrotask(() => this.restore())),
      dock.onDidLayoutFromJSON(() => this.forget()),
    ];
    addEventListener("pointerdown", this.dragged, { capture: true });
  }

  // Call it before a panel is opened.
  add(): void {
    this.arrangements.push(this.dock.toJSON());
  }

  end(): void {
    this.ends.forEach((end) => end.dispose());
    removeEventListener("pointerdown", this.dragged, { capture: true });
  }

  forget(): void {
    this.arrangements = [];
  }

  private restore(): void {
    if (this.arrangements.length === 0) {
      return;
    }
    const now = this.dock.toJSON();
    for (const before of this.arrangements.toReversed()) {
      const found = restored(before, now);
      if (found !== null) {
        const kept = this.arrangements.slice(0, this.arrangements.indexOf(before));
        this.dock.fromJSON(found, { reuseExistingPanels: true });
        this.arrangements = kept;
        return;
      }
    }
  }

  // A border that was moved by hand stays.
  private dragged = ({ target }: PointerEvent) => {
    if (target instanceof Element && target.classList.contains("dv-sash")) {
      this.forget();
    }
  };
}

// The groups with their panels, without sizes; a branch with one child is its child.
function structure(node: PanelNode): string {
  if (!Array.isArray(node.data)) {
    const { id, views } = node.data as PanelLeaf;
    return JSON.stringify([id, views]);
  }
  const children = node.data as PanelNode[];
  const only = children.length === 1 ? children[0] : undefined;
  return only !== undefined ? structure(only) : `[${children.map(structure).join()}]`;
}

function leaves(node: PanelNode): PanelLeaf[] {
  return Array.isArray(node.data) ? (node.data as PanelNode[]).flatMap(leaves) : [node.data as PanelLeaf];
}

function replaced(node: PanelNode, present: Map<string, PanelLeaf>): PanelNode {
  return Array.isArray(node.data)
    ? { ...node, data: (node.data as PanelNode[]).map((child) => replaced(child, present)) }
    : { ...node, data: present.get((node.data as PanelLeaf).id) ?? node.data };
}
