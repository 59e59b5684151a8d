// How the ports of a box look while a connection is made. A text, so that boxes that look the same are not
// drawn again.

import { useMemo } from "react";

import { type Fitting, stateOf, useWiring } from "./wiring";

export type PortFits = { box: Fitting | "start" | ""; ports: Map<string, Fitting | "start"> };

const NONE: PortFits = { box: "", ports: new Map() };

export function usePortFits(element: string): PortFits {
  const text = useWiring(({ wiring }) => {
    if (wiring === null || wiring.fits === null) {
      return "";
    }
    const own = wiring.fits.ports.filter((fit) => fit.element === element);
    const start = wiring.from.element === element ? [[wiring.from.port, "start"]] : [];
    return JSON.stringify([...start, ...own.map((fit) => [fit.port, stateOf(fit)])]);
  });
  return useMemo(() => {
    if (text === "") {
      return NONE;
    }
    const ports = new Map(JSON.parse(text) as [string, Fitting | "start"][]);
    const all = [...ports.values()];
    const box = (["start", "yes", "offer"] as const).find((one) => all.includes(one)) ?? "no";
    return { box, ports };
  }, [text]);
}
