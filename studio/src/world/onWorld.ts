// Draws when something moved in the world, at most once for each picture of the browser.

import { onPictures } from "../plots/scenes/useWebGL";
import { live } from "../server/live";

// Returns a function that ends it.
export function onWorld(place: Element, draw: () => void): () => void {
  const { redraw, end } = onPictures(place, draw);
  const unlisten = live.listen(redraw);
  redraw();
  return () => {
    end();
    unlisten();
  };
}
