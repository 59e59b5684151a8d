// Paths below the root, as the server writes them: parts joined by "/", the root itself is empty.

import type { Kind } from "../protocol";

export function parent(path: string): string {
  return path.split("/").slice(0, -1).join("/");
}

export function lastPart(path: string): string {
  return path.split("/").at(-1) ?? "";
}

export function joined(folder: string, name: string): string {
  return folder === "" ? name : `${folder}/${name}`;
}

// The folders on the way to a folder, each with its path: for "a/b" a and a/b.
export function steps(folder: string): { name: string; path: string }[] {
  const parts = folder === "" ? [] : folder.split("/");
  return parts.map((name, i) => ({ name, path: parts.slice(0, i + 1).join("/") }));
}

// The last part of a folder of the system, "/data/models" or "C:\models", to call the root by.
export function rootName(root: string): string {
  return root.split(/[\\/]/).filter(Boolean).at(-1) ?? root;
}

// Whether a path is one of the system, from its top: a file that was opened. What was dropped on the page has
// only a name.
export function isWhole(path: string): boolean {
  return /^([\\/]|[a-z]:)/i.test(path);
}

// A path of the system as it is below the root; others as they are.
export function belowRoot(root: string, path: string): string {
  const rest = path.startsWith(root) ? path.slice(root.length) : "";
  return /^[\\/]/.test(rest) ? rest.slice(1).replaceAll("\\", "/") : path;
}

export function withEnding(name: string): string {
  const trimmed = name.trim();
  return /\.(json|deodar)$/i.test(trimmed) ? trimmed : `${trimmed}.json`;
}

// Why a document cannot have this name; empty where it can.
export function nameProblem(name: string): string {
  const trimmed = name.trim();
  if (trimmed === "" || /^\.(json|deodar)$/i.test(trimmed)) {
    return "Give the file a name.";
  }
  if (/[\\/]/.test(trimmed)) {
    return "A name without / and \\; choose the folder in the list.";
  }
  // biome-ignore lint/suspicious/noControlCharactersInRegex: a name must not have any
  if (/[<>:"|?*\u0000-\u001f]/.test(trimmed)) {
    return 'A name without any of < > : " | ? *';
  }
  return trimmed.startsWith(".") ? "A name that does not begin with a dot." : "";
}

export type FileSort = "document" | "package" | "other";

// What a file of the person's own is, from its type and its name.
export function sortOf(file: { name: string; type: string }): FileSort {
  if (file.type === "application/json" || /\.(json|dnf|m)$/i.test(file.name)) {
    return "document";
  }
  if (/\.deodar$/i.test(file.name)) {
    return "package";
  }
  return "other";
}

// The kind of world that opens files with the ending of a name. Of several it is the one that lists the
// ending earliest, because each kind lists its own formats first.
export function opening(kinds: Iterable<Kind>, name: string): Kind | undefined {
  const lower = name.toLowerCase();
  let first: { kind: Kind; at: number } | undefined;
  for (const kind of kinds) {
    const at = kind.opens.findIndex((ending) => lower.endsWith(ending));
    if (at >= 0 && (first === undefined || at < first.at)) {
      first = { kind, at };
    }
  }
  return first?.kind;
}
