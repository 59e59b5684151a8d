// A switch between two values of a number: one number of an element, or a document parameter.

import { Switch } from "@mantine/core";

import { useOffline } from "../widgets/NeedsServer";
import type { Setting } from "../actions/setting";
import { ProblemLine } from "../widgets/ProblemLine";
import { numberText } from "../model/number";

type SwitchControlProps = { label: string; setting: Setting<number | null>; off: number; on: number };

export function SwitchControl({ label, setting, off, on }: SwitchControlProps) {
  const offline = useOffline();
  const { value, problem, commit } = setting;
  return (
    <div className="switch-control">
      <Switch
        size="sm"
        aria-label={label}
        checked={value === on}
        disabled={offline}
        onChange={(event) => void commit(event.currentTarget.checked ? on : off)}
      />
      <span className="dim numbers">{value === null ? "none" : numberText(value)}</span>
      <ProblemLine problem={problem} />
    </div>
  );
}
