// The connection that is being made: where it begins, and what fits its other end.

import { create } from "zustand";

import type { Fits, FitView } from "../protocol";
import { socket } from "../socket";
import { useStudio } from "../store";
import type { End, Side, WireEnds } from "./ends";

export type Wiring = {
  from: End;
  // The side on which it begins.
  side: Side;
  // Null until the server has answered.
  fits: Fits | null;
  // The connection whose end is moved.
  moved?: WireEnds;
};

type State = {
  wiring: Wiring | null;
  // The element that the keyboard has reached.
  target: string | null;
};

export const useWiring = create<State>(() => ({ wiring: null, target: null }));

let coming: Promise<Fits | null> = Promise.resolve(null);

// The last question, by port and version of the document.
let asked: { key: string; answer: Promise<Fits | null> } | null = null;

// Ask what fits a port: when the pointer reaches the port already, so that the answer is there when it is
// pressed.
export function askFits({ element, port }: End): Promise<Fits | null> {
  const { session, version } = useStudio.getState();
  const key = [session, version, element, port].join(" ");
  if (asked?.key !== key) {
    const answer = socket.ask({ type: "fits", element, port }).then(({ answer: { problems = [] }, fits }) => {
      for (const problem of problems) {
        useStudio.getState().notify(problem);
      }
      return fits;
    });
    asked = { key, answer };
  }
  return asked.answer;
}

// Begin a connection at a port, or move the other end of one; the ports that fit light up when the server has
// answered.
export function begin(from: End, side: Side, moved?: WireEnds): Promise<Fits | null> {
  const wiring: Wiring = { from, side, fits: null, moved };
  useWiring.setState({ wiring, target: null });
  coming = askFits(from).then((fits) => {
    if (useWiring.getState().wiring === wiring) {
      useWiring.setState({ wiring: { ...wiring, fits } });
    }
    return fits;
  });
  return coming;
}

export function end(): void {
  useWiring.setState({ wiring: null, target: null });
}

// What is known of the present connection, once the server has answered.
export async function judged(): Promise<(Wiring & { fits: Fits }) | null> {
  const { wiring } = useWiring.getState();
  const fits = wiring?.fits ?? (await coming);
  return wiring === null || fits === null ? null : { ...wiring, fits };
}

export type Fitting = "yes" | "offer" | "no";

export function stateOf(fit: FitView): Fitting {
  return fit.fits ? "yes" : fit.offers.length > 0 ? "offer" : "no";
}

export function fitOf(fits: Fits, element: string, port: string | null): FitView | undefined {
  const own = fits.ports.filter((fit) => fit.element === element);
  const rank = (fit: FitView) => ["yes", "offer", "no"].indexOf(stateOf(fit));
  return port === null ? own.sort((a, b) => rank(a) - rank(b))[0] : own.find((fit) => fit.port === port);
}
