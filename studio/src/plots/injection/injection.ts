// Injection into a field with the right button of the mouse, a finger or the key i. An outline shows the
// Gaussian.

import { socket } from "../../socket";
import { useStudio } from "../../store";
import { portColor, shade } from "../colors/colors";
import { paintGhost, type ValuePlane } from "./ghost";
import { Pusher } from "./pusher";
import { type Injection, spot } from "../spot";

// A drawing into which a hand injects; `pointed` is the position under the pointer.
type Pushed = ValuePlane & Readonly<{ host: HTMLElement; pointed: () => [number, number] }>;

// Listens on a drawing; `given` returns the input to inject, or null if the element takes none. Returns a
// function that ends it.
export function attachInjection(drawing: Pushed, given: () => Injection | null): () => void {
  const { host, over } = drawing;
  const ask = () => (useStudio.getState().connection === "open" ? given() : null);
  const pusher = new Pusher((message) => socket.post(message));
  const ghost = document.createElement("canvas");
  ghost.className = "plot-ghost";
  over.append(ghost);
  let boost = false;

  const push = (place: number[]) => {
    const injection = ask();
    if (injection !== null) {
      pusher.push(injection.element.id, spot(injection, boost ? null : place));
      paintGhost(ghost, drawing, injection, boost ? null : place, portColor("input", [], shade()));
    }
  };
  const stop = () => {
    pusher.release();
    ghost.toggleAttribute("data-on", false);
  };
  const placeOf = (event: PointerEvent) => {
    const box = over.getBoundingClientRect();
    return drawing.valuesAt([event.clientX - box.left, event.clientY - box.top]);
  };

  const listening = new AbortController();
  const { signal } = listening;
  over.style.touchAction = "none"; // the browser would move the page under the finger
  over.addEventListener("contextmenu", (event) => ask() !== null && event.preventDefault(), { signal });
  over.addEventListener(
    "pointerdown",
    (event) => {
      const finger = event.pointerType === "touch" && event.isPrimary;
      if ((event.button === 2 || finger) && ask() !== null) {
        event.preventDefault();
        boost = event.shiftKey;
        push(placeOf(event));
      }
    },
    { signal },
  );
  over.addEventListener("pointermove", (event) => pusher.pushing && push(placeOf(event)), { signal });
  for (const end of ["pointerup", "pointercancel", "pointerleave"] as const) {
    over.addEventListener(end, stop, { signal });
  }
  window.addEventListener("blur", stop, { signal });
  window.addEventListener("keydown", (event) => event.key === "Escape" && stop(), { signal });
  host.addEventListener(
    "keydown",
    (event) => {
      if (
        event.code === "KeyI" &&
        !event.repeat &&
        !event.ctrlKey &&
        !event.metaKey &&
        !event.altKey &&
        ask() !== null
      ) {
        boost = event.shiftKey;
        push(drawing.pointed());
      }
    },
    { signal },
  );
  host.addEventListener("keyup", (event) => event.code === "KeyI" && stop(), { signal });
  host.addEventListener("blur", stop, { signal });

  return () => {
    listening.abort();
    stop();
    ghost.remove();
  };
}
