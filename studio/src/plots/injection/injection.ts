// Injection into a field with the right button of the mouse, a finger or the key i. An outline shows the
// Gaussian.

import { Held } from "../../server/held";
import type { PushInput, Release } from "../../protocol";
import { socket } from "../../server/socket";
import { useStudio } from "../../server/store";
import { portColor, shade } from "../../model/colors";
import { paintGhost, type ValuePlane } from "./ghost";
import { type Injection, spot } from "./spot";

// A drawing into which a hand injects; `pointed` is the position under the pointer.
type Pushed = ValuePlane & Readonly<{ host: HTMLElement; pointed: () => [number, number] }>;

// Listens on a drawing; `given` returns the input to inject, or null if the element takes none. Returns a
// function that ends it.
export function attachInjection(drawing: Pushed, given: () => Injection | null): () => void {
  const { host, over } = drawing;
  const ask = () => (useStudio.getState().connection === "open" ? given() : null);
  const pusher = new Held<PushInput | Release>((message) => socket.ask(message));
  const ghost = document.createElement("canvas");
  ghost.className = "plot-ghost";
  over.append(ghost);
  let boost = false;

  const push = (place: number[]) => {
    const injection = ask();
    if (injection !== null) {
      pusher.move({
        type: "push",
        element: injection.element.id,
        ...spot(injection, boost ? null : place),
      });
      paintGhost(ghost, drawing, injection, boost ? null : place, portColor("input", [], shade()));
    }
  };
  const stop = () => {
    if (pusher.isDown) {
      pusher.move({ type: "release" });
      pusher.release();
    }
    ghost.toggleAttribute("data-on", false);
  };
  const placeOf = (event: PointerEvent) => {
    const box = over.getBoundingClientRect();
    return drawing.valuesAt([event.clientX - box.left, event.clientY - box.top]);
  };

  const listening = new AbortController();
  const on = <K extends keyof HTMLElementEventMap>(
    target: HTMLElement | Window,
    type: K,
    act: (event: HTMLElementEventMap[K]) => void,
  ) => target.addEventListener(type, act as EventListener, { signal: listening.signal });
  over.style.touchAction = "none"; // the browser would move the page under the finger
  on(over, "contextmenu", (event) => ask() !== null && event.preventDefault());
  on(over, "pointerdown", (event) => {
    const finger = event.pointerType === "touch" && event.isPrimary;
    if ((event.button === 2 || finger) && ask() !== null) {
      event.preventDefault();
      boost = event.shiftKey;
      push(placeOf(event));
    }
  });
  on(over, "pointermove", (event) => pusher.isDown && push(placeOf(event)));
  for (const end of ["pointerup", "pointercancel", "pointerleave"] as const) {
    on(over, end, stop);
  }
  on(window, "blur", stop);
  on(window, "keydown", (event) => event.key === "Escape" && stop());
  on(host, "keydown", ({ code, repeat, ctrlKey, metaKey, altKey, shiftKey }) => {
    if (code === "KeyI" && !(repeat || ctrlKey || metaKey || altKey) && ask() !== null) {
      boost = shiftKey;
      push(drawing.pointed());
    }
  });
  on(host, "keyup", (event) => event.code === "KeyI" && stop());
  on(host, "blur", stop);
  return () => {
    listening.abort();
    stop();
    ghost.remove();
  };
}
