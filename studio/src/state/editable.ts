import { useStudio } from "../server/store";

// Why the document cannot be changed; empty where it can.
export function whyFixed(): string {
  const { document, connection } = useStudio.getState();
  return document === null || connection !== "open"
    ? "There is no connection to the server."
    : document.record != null
      ? "A record is not changed; its model can be."
      : "";
}

export const isEditable = (): boolean => whyFixed() === "";
