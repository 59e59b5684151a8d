// What a right-click on a plot injects.

import { NumberInput, Text } from "@mantine/core";
import type { PlotSettings } from "../settings";

type PushSettings = { amplitude: number; width: number; set: (settings: Partial<PlotSettings>) => void };

export function PushControl({ amplitude, width, set }: PushSettings) {
  return (
    <>
      <div className="plot-pair">
        <NumberInput
          size="xs"
          label="Injected amplitude"
          value={amplitude}
          step={1}
          onChange={(value) => typeof value === "number" && set({ amplitude: value })}
        />
        <NumberInput
          size="xs"
          label="Width (% of axis)"
          value={Number((100 * width).toPrecision(6))}
          min={0.1}
          max={100}
          step={1}
          onChange={(value) => typeof value === "number" && value > 0 && set({ width: value / 100 })}
        />
      </div>
      <Text size="xs" c="dimmed">
        Hold the right button or a finger on the plot, or the key I, to inject a Gaussian; with Shift the same
        everywhere.
      </Text>
    </>
  );
}
