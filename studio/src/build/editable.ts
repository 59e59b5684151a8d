import { useStudio } from "../store";

// Whether the document can be changed: a record cannot, and without a connection nothing can.
export function isEditable(): boolean {
  const { document, connection } = useStudio.getState();
  return document !== null && document.record == null && connection === "open";
}
