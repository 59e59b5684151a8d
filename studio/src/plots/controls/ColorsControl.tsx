// Settings of values that are shown as colours: the scale of colours, and the range.

import { ColorControl } from "./ColorControl";
import type { Range } from "../../draw/scale";
import { RangeControl } from "./RangeControl";
import type { PlotSettings } from "../settings";

type ColorsControlProps = {
  settings: PlotSettings;
  // The range that is shown now.
  shown: () => Range;
  set: (settings: Partial<PlotSettings>) => void;
};

export function ColorsControl({ settings, shown, set }: ColorsControlProps) {
  return (
    <>
      <ColorControl scale={settings.scale} set={(scale) => set({ scale })} />
      <RangeControl range={settings.range} shown={shown} set={(range) => set({ range })} />
    </>
  );
}
