// The label of a coupling on its edge: its kind if its name was made from the connection (`source>Kind`,
// `source>Kind2`).
export function labelOf(name: string, kind: string, title: string): string {
  const made = name.slice(name.lastIndexOf(">") + 1).replace(/\d+$/, "") === kind && name.includes(">");
  return made && title !== "" ? title : name;
}
