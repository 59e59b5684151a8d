// The connection that is being made: where it begins, and what fits its other end.

import { create } from "zustand";

import type { Fits, FitView } from "../protocol";
import { socket } from "../server/socket";
import { useStudio } from "../server/store";
import { grouped } from "../model/values";
import type { End, Side, WireEnds } from "../model/ends";

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
      if (problems.length > 0) {
        useStudio.getState().notify(problems);
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

// The best of what is known of several ports.
export const bestOf = (states: (Fitting | "start")[]): Fitting | "start" =>
  (["start", "yes", "offer"] as const).find((one) => states.includes(one)) ?? "no";

// The judged ports of each element.
const tables = new WeakMap<Fits, Map<string, FitView[]>>();

function portsOf(fits: Fits, element: string): FitView[] {
  let table = tables.get(fits);
  if (table === undefined) {
    table = new Map(grouped(fits.ports, ({ element: id }) => id));
    tables.set(fits, table);
  }
  return table.get(element) ?? [];
}

export function fitOf(fits: Fits, element: string, port: string | null): FitView | undefined {
  const own = [...portsOf(fits, element)];
  const rank = (fit: FitView) => ["yes", "offer", "no"].indexOf(stateOf(fit));
  return port === null ? own.sort((a, b) => rank(a) - rank(b))[0] : own.find((fit) => fit.port === port);
}

export type Hint = { text: string; ok: boolean };

// What is said of an element or of one of its ports: why it does not fit, or how the connection changes the
// values. Null: nothing.
export function hintOf(
  { from, side, fits }: Wiring & { fits: Fits },
  element: string,
  port: string | null,
): Hint | null {
  const fit = fitOf(fits, element, port);
  if (fit !== undefined) {
    return fit.reason === "" ? null : { text: fit.reason, ok: fit.fits };
  }
  if (from.element === element && (port ?? from.port) === from.port) {
    return null;
  }
  // the server judges the ports of the other side alone
  const [own, other] = side === "source" ? ["output", "input"] : ["input", "output"];
  const none = portsOf(fits, element).length === 0;
  return {
    text: none ? `This element has no ${other}.` : `This is an ${own}: drag to an ${other}.`,
    ok: false,
  };
}

// What is said of a folded group: null where one of the ports that it shows can be connected.
export function groupHintOf(wiring: Wiring & { fits: Fits }, shown: End[]): Hint | null {
  return bestOf(shown.flatMap((end) => stateAt(end, wiring) || [])) === "no"
    ? { text: "No port that this group shows fits. Unfold it to reach the others.", ok: false }
    : null;
}

// How a port looks: where the connection begins, whether it fits, or "" without a connection. A port on the
// side where the connection begins does not fit.
export function stateAt({ element, port }: End, wiring: Wiring | null): Fitting | "start" | "" {
  if (wiring === null || wiring.fits === null) {
    return "";
  }
  if (element === wiring.from.element && port === wiring.from.port) {
    return "start";
  }
  const fit = portsOf(wiring.fits, element).find((one) => one.port === port);
  return fit === undefined ? "no" : stateOf(fit);
}
