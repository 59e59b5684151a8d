// The choice of a scale of colours.

import { NativeSelect } from "@mantine/core";
import { type ScaleName, SCALES } from "../colors/colors";

type ColorChoice = { scale: ScaleName | "auto"; set: (scale: ScaleName | "auto") => void };

export function ColorControl({ scale, set }: ColorChoice) {
  return (
    <NativeSelect
      size="xs"
      label="Colours"
      data={[
        { value: "auto", label: "Fitting the port" },
        ...SCALES.map((other) => ({ value: other.name, label: other.label })),
      ]}
      value={scale}
      onChange={(event) => set(event.currentTarget.value as ScaleName | "auto")}
    />
  );
}
