// What a person can do about a problem: choose what is missing, or make the edit that solves it, as one step
// of undo.

import { Group } from "@mantine/core";
import { useState } from "react";

import { ask } from "../state/questions";
import { newGesture } from "../server/held";
import { onCanvas } from "../actions/showGoal";
import type { ListedProblem } from "../protocol";
import { request } from "../server/socket";
import { useStudio } from "../server/store";
import { PanelButton } from "../widgets/Buttons";
import { useChooser } from "../state/choice";
import { signalEntries } from "../actions/palette";
import { besideOnScreen, complete } from "../actions/connecting";

type Action = { label: string; run: () => unknown };

export function RepairButtons({ problem }: { problem: ListedProblem }) {
  const [busy, setBusy] = useState("");
  const actions = actionsOf(problem);
  if (actions.length === 0) {
    return null;
  }
  return (
    <Group gap={6} mt={6}>
      {actions.map(({ label, run }) => (
        <PanelButton
          key={label}
          size="compact-xs"
          label={label}
          loading={busy === label}
          onClick={() => {
            setBusy(label);
            void Promise.resolve(run()).finally(() => setBusy(""));
          }}
        />
      ))}
    </Group>
  );
}

function actionsOf({ what, where = "", element = "", repair = "", wire, world }: ListedProblem): Action[] {
  const actions: Action[] = [];
  if (wire != null) {
    const label = wire.source === "" || wire.target === "" ? "Connect…" : "Choose a coupling…";
    actions.push({ label, run: () => onCanvas(() => complete(wire)) });
  }
  if (world === true) {
    const kind = useStudio.getState().elements.get(element)?.kind;
    if (kind !== undefined) {
      actions.push({ label: `Choose a ${kind.toLowerCase()}…`, run: () => chooseSignal(element, kind) });
    }
    actions.push({ label: "Other world…", run: () => void ask("world", null) });
  }
  if (repair !== "") {
    actions.push({ label: repair, run: () => request({ type: "repair", where, what }) });
  }
  return actions;
}

// Another sensor or motor of the world for an element, with its axes.
function chooseSignal(element: string, kind: string): void {
  const { kinds, offered } = useStudio.getState();
  const entries = signalEntries(offered, kinds, (_, values) => {
    const gesture = newGesture();
    for (const [parameter, value] of Object.entries(values ?? {})) {
      void request({ type: "set", element, parameter, value, gesture });
    }
  });
  useChooser.getState().open({
    label: `Choose a ${kind.toLowerCase()}`,
    placeholder: "Name",
    at: besideOnScreen(element),
    entries: entries.filter((entry) => entry.kind?.name === kind),
    empty: "The world has none",
  });
}
