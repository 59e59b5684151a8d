// The duration that a plot over time shows.

import { SegmentedControl, Text } from "@mantine/core";
import { useStudio } from "../../store";
import { WINDOWS } from "../settings";

type WindowChoice = { window: number | null; set: (window: number | null) => void };

export function WindowControl({ window, set }: WindowChoice) {
  const unit = useStudio((state) => state.document?.time_unit);
  return (
    <div>
      <Text size="xs" fw={500} mb={2}>
        Newest {unit ?? "time units"} shown
      </Text>
      <SegmentedControl
        size="xs"
        fullWidth
        aria-label="Displayed duration"
        data={WINDOWS.map((length) => ({
          value: String(length),
          label: length === null ? "all" : String(length),
        }))}
        value={String(window)}
        onChange={(value) => set(value === "null" ? null : Number(value))}
      />
    </div>
  );
}
