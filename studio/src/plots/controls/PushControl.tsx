// What a right-click on a plot injects.

import { Text } from "@mantine/core";

import { NumberField } from "../../widgets/NumberField";
import type { PlotSettings } from "../settings";

type PushSettings = { amplitude: number; width: number; set: (settings: Partial<PlotSettings>) => void };

export function PushControl({ amplitude, width, set }: PushSettings) {
  return (
    <>
      <div className="plot-pair">
        <NumberField
          label="Injected amplitude"
          value={amplitude}
          set={(value) => set({ amplitude: value })}
        />
        <NumberField
          label="Width (% of axis)"
          value={100 * width}
          lower={0.1}
          upper={100}
          set={(value) => set({ width: value / 100 })}
        />
      </div>
      <Text size="xs" c="dimmed">
        Hold the right button or a finger on the plot, or the key I, to inject a Gaussian; with Shift the same
        everywhere.
      </Text>
    </>
  );
}
