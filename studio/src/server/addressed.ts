// Requests that change the open document name the document that they are meant for: where another page opened
// another one since, the server refuses them.

import { MEANT, type ToServer } from "../protocol";

const meant = new Set<ToServer["type"]>(MEANT);

export function addressed(message: ToServer, session: number): ToServer {
  return meant.has(message.type) ? ({ ...message, session } as ToServer) : message;
}
