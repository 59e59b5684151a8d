// The groups of a document as a tree, and where an element is seen when groups are folded.

import type { ElementView } from "../protocol";

export type Branch = {
  // The path joined by "/", as layout.folded has it; "" is the root.
  key: string;
  name: string;
  folded: boolean;
  groups: Branch[];
  elements: string[];
  // Elements in it, at any depth.
  count: number;
};

export type Tree = {
  root: Branch;
  groups: Map<string, Branch>;
  // The group that contains an element or a group: by element id, or by key.
  home: Map<string, string>;
  outer: Map<string, string>;
};

export const keyOf = (path: string[]): string => path.join("/");

// The tree of the groups; elements that are drawn on edges are left out.
export function tree(
  elements: ElementView[],
  groups: string[][],
  folded: string[],
  without: Set<string>,
): Tree {
  const closed = new Set(folded);
  const root: Branch = { key: "", name: "", folded: false, groups: [], elements: [], count: 0 };
  const found: Tree = { root, groups: new Map([["", root]]), home: new Map(), outer: new Map() };
  const branch = (path: string[]): Branch => {
    const key = keyOf(path);
    let group = found.groups.get(key);
    if (group === undefined) {
      const above = branch(path.slice(0, -1));
      group = {
        key,
        name: path[path.length - 1] ?? "",
        folded: closed.has(key),
        groups: [],
        elements: [],
        count: 0,
      };
      above.groups.push(group);
      found.groups.set(key, group);
      found.outer.set(key, above.key);
    }
    return group;
  };
  for (const path of groups) {
    branch(path);
  }
  for (const element of elements) {
    for (let depth = 0; depth <= element.group.length; depth++) {
      branch(element.group.slice(0, depth)).count += 1;
    }
    const home = branch(element.group);
    found.home.set(element.id, home.key);
    if (!without.has(element.id)) {
      home.elements.push(element.id);
    }
  }
  return found;
}

// The groups around an element, the outermost first.
export function around(found: Tree, element: string): Branch[] {
  return upTo(found, found.home.get(element) ?? "");
}

// The groups around a group, the outermost first.
export function outside(found: Tree, group: string): Branch[] {
  return upTo(found, found.outer.get(group) ?? "");
}

function upTo(found: Tree, last: string): Branch[] {
  const path: Branch[] = [];
  for (let key = last; key !== ""; key = found.outer.get(key) ?? "") {
    const group = found.groups.get(key);
    if (group !== undefined) {
      path.unshift(group);
    }
  }
  return path;
}

// The folded group that hides an element; null where it is seen itself.
export function hiddenBy(found: Tree, element: string): Branch | null {
  return around(found, element).find((group) => group.folded) ?? null;
}

// Every element at any depth below a group, except those on edges.
export function below(group: Branch): string[] {
  return [...group.elements, ...group.groups.flatMap(below)];
}
