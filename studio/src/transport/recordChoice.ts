// What the next record holds: the ports, and how often they are sampled.

import { portsOf } from "../model/ports";
import type { ElementView, RecordedPort } from "../protocol";
import { pageStore } from "../state/pageStore";

type RecordChoice = {
  // Null: the plotted ones.
  ports: RecordedPort[] | null;
  // Document time between two samples; null: every step.
  every: number | null;
};

export const useRecordChoice = pageStore<RecordChoice>(() => ({ ports: null, every: null }));

// The ports whose name contains a text, in the order of the document; those that are ticked come first.
export function findPorts(elements: ElementView[], ticked: RecordedPort[], search: string): RecordedPort[] {
  const wanted = search.trim().toLowerCase();
  const all = elements.flatMap((element) =>
    portsOf(element)
      .filter((port) => portName(element, port).toLowerCase().includes(wanted))
      .map((port) => ({ element: element.id, port })),
  );
  return [...all.filter((port) => isIn(ticked, port)), ...all.filter((port) => !isIn(ticked, port))];
}

export function portName(element: ElementView, port: string): string {
  return `${element.path}.${port}`;
}

export function isIn(ports: RecordedPort[], { element, port }: RecordedPort): boolean {
  return ports.some((other) => other.element === element && other.port === port);
}

// The ports with one more, or without it.
export function toggled(ports: RecordedPort[], port: RecordedPort): RecordedPort[] {
  return isIn(ports, port)
    ? ports.filter((other) => other.element !== port.element || other.port !== port.port)
    : [...ports, port];
}
