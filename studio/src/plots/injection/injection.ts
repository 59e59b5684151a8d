// Injection into a field with the right button of the mouse, a finger or the key i. An outline shows the
// Gaussian.

import type uPlot from "uplot";
import { socket } from "../../socket";
import { useStudio } from "../../store";
import { paintGhost } from "../chart/ghost";
import { Pusher } from "./pusher";
import { type Injection, spot } from "../spot";

// Listens on a chart; `given` returns the input to inject, or null if the element takes none. Returns a
// function that ends it.
export function attachInjection(
  chart: uPlot,
  host: HTMLElement,
  given: () => Injection | null,
  color: string,
): () => void {
  const ask = () => (useStudio.getState().connection === "open" ? given() : null);
  const pusher = new Pusher((message) => socket.post(message));
  const ghost = document.createElement("canvas");
  ghost.className = "plot-ghost";
  chart.over.append(ghost);
  let boost = false;

  const push = (place: number[]) => {
    const injection = ask();
    if (injection !== null) {
      pusher.push(injection.element.id, spot(injection, boost ? null : place));
      paintGhost(ghost, chart, injection, boost ? null : place, color);
    }
  };
  const stop = () => {
    pusher.release();
    ghost.toggleAttribute("data-on", false);
  };
  const placeOf = (event: PointerEvent) => {
    const box = chart.over.getBoundingClientRect();
    return placeAt(chart, event.clientX - box.left, event.clientY - box.top);
  };

  const listening = new AbortController();
  const { signal } = listening;
  const { over } = chart;
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
  over.addEventListener(
    "pointermove",
    (event) => {
      if (pusher.pushing) {
        push(placeOf(event));
        // uPlot follows the mouse only while no button is down.
        const box = over.getBoundingClientRect();
        chart.setCursor({ left: event.clientX - box.left, top: event.clientY - box.top });
      }
    },
    { signal },
  );
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
        push(cursorOrCentre(chart));
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

function placeAt(chart: uPlot, left: number, top: number): number[] {
  return [chart.posToVal(left, "x"), chart.posToVal(top, "y")];
}

function cursorOrCentre(chart: uPlot): number[] {
  const { left = -1, top = -1 } = chart.cursor;
  return left >= 0
    ? placeAt(chart, left, top)
    : placeAt(chart, chart.over.clientWidth / 2, chart.over.clientHeight / 2);
}
