// Where the trials of a run are computed, as the user chooses it.

import { create } from "zustand";

import type { RunExperiment, RunView } from "../protocol";

export type RunPlace = {
  on: "machine" | "cluster";
  // Number of processes on this machine; none: the usual number.
  workers: number | null;
  address: string;
  // Seconds without any worker after which a run ends.
  patience: number;
  trust: boolean;
  mixed: boolean;
};

export const PATIENCE = 60;

// The choice holds for all experiments, as long as the page is open.
export const useRunPlace = create<RunPlace>(() => ({
  on: "machine",
  workers: null,
  address: "",
  patience: PATIENCE,
  trust: false,
  mixed: false,
}));

type RunPlaceRequest = Omit<RunExperiment, "type" | "request" | "session">;

// What a request to run says of the place.
export function requestOf({ on, workers, address, patience, trust, mixed }: RunPlace): RunPlaceRequest {
  return on === "machine"
    ? { workers: workers ?? 0 }
    : { cluster: address.trim(), patience, trust_network: trust, mixed };
}

// Whether a run can begin there.
export const isStated = ({ on, address }: RunPlace): boolean => on === "machine" || address.trim() !== "";

// The place in a few words.
export function placeText({ on, workers, address }: RunPlace, usual: number): string {
  return on === "machine" ? processes(workers ?? usual) : address.trim() || "a cluster";
}

const processes = (count: number): string => (count === 1 ? "1 process" : `${count} processes`);

// How far a run is, without its number of trials: a line each.
export function standingLines(run: RunView): string[] {
  const { state, slowest, diverged } = run;
  if (state !== "running" && state !== "followed") {
    return [];
  }
  const followed = "Another process runs this experiment. Its rows are read every second.";
  return [
    state === "running" ? staffText(run) : followed,
    ...(slowest === "" ? [] : [`Slowest: ${slowest}`]),
    ...diverged.map((cell) => `Diverged: ${cell}`),
  ];
}

function staffText({ cluster, workers, pieces, stopping }: RunView): string {
  if (stopping) {
    return "Stopping";
  }
  const where = cluster === "" ? "" : ` of ${cluster}`;
  if (workers === 0) {
    return cluster === "" ? "Processes start" : `Waiting for the workers${where}`;
  }
  const given = pieces === 1 ? "1 piece" : `${pieces} pieces`;
  return `${workers} worker${workers === 1 ? "" : "s"}${where}, ${given} in flight`;
}

export function secondsText(seconds: number): string {
  const minutes = Math.ceil(seconds / 60);
  if (seconds < 90) {
    return `${Math.ceil(seconds)} s`;
  }
  return minutes < 90 ? `${minutes} min` : `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}
