// An array: its shape and range, read only, and a button that plots it where it has two axes or more.

import { IconChartGridDots } from "@tabler/icons-react";

import { openPlot } from "../actions/openPlot";
import { weightsOf } from "../model/ports";
import { useStudio } from "../server/store";
import { numberText } from "../model/number";
import { TipButton } from "../widgets/TipButton";
import { ParameterRow } from "./ParameterRow";
import { usePlace } from "../state/place";
import type { FormProps } from "./props";

export function ArrayForm({ form, path, value }: FormProps) {
  const { element } = usePlace();
  const plotted = useStudio(({ document, elements, kinds }) => {
    const found = elements.get(element);
    return (
      document !== null &&
      found !== undefined &&
      weightsOf(document, found, kinds.get(found.kind)).some(({ name }) => name === path)
    );
  });
  return (
    <ParameterRow form={form} path={path} value={value} inline onReset={() => undefined}>
      <span className="dim one-line grow" title={arrayText(value)}>
        {arrayText(value)}
      </span>
      {plotted && (
        <TipButton tip={`Plot ${path}`} size="sm" onClick={() => openPlot({ element, kind: "weights" })}>
          <IconChartGridDots size={15} />
        </TipButton>
      )}
    </ParameterRow>
  );
}

// Shape and range if the server states them, else the name of the stored array.
export function arrayText(value: unknown): string {
  if (typeof value !== "object" || value === null) {
    return "none";
  }
  const { shape, min, max, array, digest } = value as Record<string, unknown>;
  const size = Array.isArray(shape) ? `${shape.join(" × ")} numbers` : "";
  const range =
    typeof min === "number" && typeof max === "number" ? `${numberText(min)} to ${numberText(max)}` : "";
  const known = [size, range].filter((text) => text !== "").join(", ");
  return known || String(array ?? digest ?? "numbers");
}
