// Names of couplings on an edge.

// Whether a name was made from the connection (`source>Kind`, `source>Kind2`).
export const isUnnamed = (name: string, kind: string): boolean =>
  name.includes(">") && name.slice(name.lastIndexOf(">") + 1).replace(/\d+$/, "") === kind;

// The label of a coupling on its edge: its kind if its name was made from the connection.
export function labelOf(name: string, kind: string, title: string): string {
  return isUnnamed(name, kind) && title !== "" ? title : name;
}
