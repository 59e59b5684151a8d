// The document after an edit: what the patch does not change stays the same object.

import type { ConnectionView, DocumentView, Edited, ElementView, EndsView } from "./protocol";

export function patched(document: DocumentView, patch: Edited): DocumentView {
  const { general, groups, axes, parameters, problems, unsaved, undo, redo } = patch;
  return {
    ...document,
    ...general,
    elements: patchedElements(document.elements, patch),
    connections: patchedConnections(document.connections, patch),
    layout: patchedLayout(document.layout, patch),
    groups: groups ?? document.groups,
    axes: axes ?? document.axes,
    parameters: parameters ?? document.parameters,
    problems: problems ?? document.problems,
    unsaved,
    undo,
    redo,
  };
}

function patchedElements(before: ElementView[], { elements, moved, added, removed }: Edited): ElementView[] {
  if (elements.length === 0 && removed.length === 0 && Object.keys(moved).length === 0) {
    return before;
  }
  const next = new Map(elements.map((e) => [e.id, e]));
  const gone = new Set(removed);
  const after = before
    .filter((e) => !gone.has(e.id))
    .map((e) => {
      const other = next.get(e.id);
      const path = moved[e.id];
      if (path !== undefined) {
        return { ...e, ...path };
      }
      return other === undefined ? e : sharing(other, e);
    });
  for (const [id, index] of Object.entries(added).sort(([, a], [, b]) => a - b)) {
    const element = next.get(id);
    if (element !== undefined) {
      after.splice(index, 0, element);
    }
  }
  return after;
}

// Lists that are equal stay the same objects, so that a change of a value does not build the canvas again.
function sharing(next: ElementView, before: ElementView): ElementView {
  return {
    ...next,
    group: alike(next.group, before.group) ? before.group : next.group,
    inputs: alike(next.inputs, before.inputs) ? before.inputs : next.inputs,
    outputs: alike(next.outputs, before.outputs) ? before.outputs : next.outputs,
    axes: alike(next.axes, before.axes) ? before.axes : next.axes,
  };
}

function alike(one: unknown, other: unknown): boolean {
  return JSON.stringify(one) === JSON.stringify(other);
}

function patchedConnections(before: ConnectionView[], patch: Edited): ConnectionView[] {
  const { removed, disconnected, connected } = patch;
  if (removed.length === 0 && disconnected.length === 0 && connected.length === 0) {
    return before;
  }
  const gone = new Set(disconnected.map(ends));
  const without = new Set(removed);
  const after = before.filter((c) => !gone.has(ends(c)) && !without.has(c.source) && !without.has(c.target));
  for (const { index, connection } of connected) {
    after.splice(index, 0, connection);
  }
  return after;
}

function ends({ source, source_port, target, target_port }: EndsView): string {
  return JSON.stringify([source, source_port, target, target_port]);
}

function patchedLayout(before: Record<string, unknown>, patch: Edited): Record<string, unknown> {
  const { layout, layout_entries } = patch;
  if (Object.keys(layout).length === 0 && Object.keys(layout_entries).length === 0) {
    return before;
  }
  const after = { ...before, ...layout };
  for (const [key, entries] of Object.entries(layout_entries)) {
    after[key] = withoutNull({ ...(after[key] as Record<string, unknown>), ...entries });
  }
  return withoutNull(after);
}

function withoutNull(layout: Record<string, unknown>): Record<string, unknown> {
  return Object.fromEntries(Object.entries(layout).filter(([, value]) => value !== null));
}
