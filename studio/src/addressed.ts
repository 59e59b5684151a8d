// Requests that change the open document name the document that they are meant for: where another page opened
// another one since, the server refuses them.

import type { ToServer } from "./protocol";

const MEANT = new Set<ToServer["type"]>([
  "add_document_parameter",
  "add_element",
  "add_template",
  "apply_preset",
  "apply_preset_text",
  "arrange",
  "close",
  "comment",
  "connect",
  "describe",
  "disconnect",
  "group",
  "insert",
  "keep_preset",
  "keep_snapshot",
  "link",
  "move_into",
  "paste",
  "place",
  "reconnect",
  "redo",
  "remove",
  "remove_document_parameter",
  "remove_kept",
  "rename",
  "return_to",
  "run_from",
  "save",
  "set",
  "set_many",
  "undo",
  "ungroup",
  "unlink",
]);

export function addressed(message: ToServer, session: number): ToServer {
  return MEANT.has(message.type) ? ({ ...message, session } as ToServer) : message;
}
