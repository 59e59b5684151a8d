// How a coupling is called on its edge: a name that was made from the connection (`source>Kind`) says no more than its kind does.
export function labelOf(name: string, title: string): string {
  return name.includes(">") && title !== "" ? title : name;
}
