// Takes the last change of the document back; a change of a plot that is not stored yet is the last one.

import type { Answer } from "../protocol";
import { request } from "../server/socket";
import { settleTiles } from "./tiles";

export function undo(): Promise<Answer> {
  settleTiles();
  return request({ type: "undo" });
}
