// How a coupling is called on its edge: a name that was made from the connection (`source>Kind`,
// `source>Kind2`) says no more than its kind does.
export function labelOf(name: string, kind: string, title: string): string {
  const made = name.slice(name.lastIndexOf(">") + 1).replace(/\d+$/, "") === kind && name.includes(">");
  return made && title !== "" ? title : name;
}
