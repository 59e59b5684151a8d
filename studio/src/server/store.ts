// The last messages of the server, and the state of the view. Live arrays do not pass through here: see
// streams.ts.

import { create } from "zustand";
import { applied } from "./applied";
import type { TrialRow } from "../model/trialRows";
import type {
  Comparison,
  RunClock,
  Costs,
  DocumentView,
  ElementView,
  ExperimentView,
  Gallery,
  ImportReportView,
  SavedFiles,
  Kind,
  ListedProblem,
  Regime,
  ToPage,
  Tuning,
  FileProblems,
  Welcome,
  WorldSignals,
} from "../protocol";

// refused: the server was restarted with another token
export type Connection = "connecting" | "open" | "lost" | "refused";

// What can be done about a notice, by a button.
export type Offer = { label: string; run: () => unknown };

export type Notice = {
  id: number;
  problems: readonly ListedProblem[];
  level: "error" | "info";
  offers: readonly Offer[];
};

export type Studio = {
  connection: Connection;
  // How often the connection was lost.
  losses: number;
  welcome: Welcome | null;
  kinds: Map<string, Kind>;
  gallery: Gallery | null;
  // session changes with each document that is opened, version with each change of it
  session: number;
  version: number;
  document: DocumentView | null;
  elements: Map<string, ElementView>;
  fileProblems: FileProblems | null;
  clock: RunClock | null;
  costs: Costs | null;
  // The regime of the field that was measured last; its element is empty before.
  regime: Regime | null;
  // The field that was tuned last; its element is empty before.
  tuning: Tuning | null;
  // The comparison of the open record with another one; null: there is none.
  comparison: Comparison | null;
  experiment: ExperimentView | null;
  // The rows of its run, as they arrive.
  trials: { run: number; rows: TrialRow[] };
  // The snapshots and presets of the open document, as listed last.
  savedFiles: SavedFiles | null;
  // The report on the file of another tool that the open document was made from; null: there is none.
  report: ImportReportView | null;
  // The sensors and motors of worlds that the document can use.
  offered: WorldSignals[];
  selected: string[];
  notice: Notice | null; // at most one: it would cover more of the page
  take: (message: ToPage) => void;
  connect: (connection: Connection) => void;
  select: (ids: string[]) => void;
  notify: (
    problem: ListedProblem | readonly ListedProblem[],
    level?: Notice["level"],
    ...offers: Offer[]
  ) => void;
  dismiss: () => void;
};

let lastNotice = 0;

export const useStudio = create<Studio>((set) => ({
  connection: "connecting",
  losses: 0,
  welcome: null,
  kinds: new Map(),
  gallery: null,
  session: 0,
  version: 0,
  document: null,
  elements: new Map(),
  fileProblems: null,
  clock: null,
  costs: null,
  regime: null,
  tuning: null,
  comparison: null,
  experiment: null,
  trials: { run: 0, rows: [] },
  savedFiles: null,
  report: null,
  offered: [],
  selected: [],
  notice: null,
  take: (message) => set((state) => taken(state, message)),
  connect: (connection) =>
    set((state) => ({
      connection,
      losses: state.losses + (state.connection === "open" && connection !== "open" ? 1 : 0),
    })),
  select: (selected) => set({ selected }),
  notify: (problem, level = "error", ...offers) =>
    set({ notice: { id: ++lastNotice, problems: [problem].flat(), level, offers } }),
  dismiss: () => set({ notice: null }),
}));

function taken(state: Studio, message: ToPage): Partial<Studio> {
  switch (message.type) {
    case "welcome":
      return { welcome: message, kinds: new Map(message.kinds.map((k) => [k.name, k])) };
    case "gallery":
      return { gallery: message };
    case "opened": {
      const elements = byId(message.document);
      const fresh = message.session !== state.session;
      return {
        session: message.session,
        version: message.version,
        document: message.document,
        elements,
        selected: fresh ? [] : state.selected.filter((id) => elements.has(id)),
        // a message on the previous document no longer applies
        notice: fresh ? null : state.notice,
      };
    }
    case "edited": {
      if (state.document === null) {
        return {};
      }
      const document = applied(state.document, message.difference);
      const elements = document.elements === state.document.elements ? state.elements : byId(document);
      const selected = state.selected.filter((id) => elements.has(id));
      return {
        version: message.version,
        document,
        elements,
        selected: selected.length === state.selected.length ? state.selected : selected,
      };
    }
    case "checked":
      return state.document === null || state.version !== message.version
        ? {}
        : { document: { ...state.document, problems: message.problems } };
    case "offered_signals":
      return { offered: message.worlds };
    case "file_problems":
      return { fileProblems: message.problems.length > 0 ? message : null };
    case "clock":
      return { clock: message };
    case "saved_files":
      return { savedFiles: message };
    case "import_report":
      return { report: message.tool === "" ? null : message };
    case "comparison":
      return { comparison: message.path === "" ? null : message };
    case "costs":
      return { costs: message };
    case "regime":
      return { regime: message };
    case "tuning":
      return { tuning: message };
    case "experiment":
      return { experiment: message };
    case "trial_rows": {
      const before = message.run === state.trials.run ? state.trials.rows.slice(0, message.first) : [];
      return { trials: { run: message.run, rows: [...before, ...(message.rows as TrialRow[])] } };
    }
    default:
      return {};
  }
}

function byId(document: DocumentView | null): Map<string, ElementView> {
  return new Map((document?.elements ?? []).map((e) => [e.id, e]));
}
