// Beside a plot, the parameters of what it shows: its axes, its interaction kernel, or its time windows.

import { ActionIcon, Popover, Tooltip } from "@mantine/core";
import { IconPencil } from "@tabler/icons-react";

import { AxisFields } from "../../forms/AxisFields";
import { ElementPlace } from "../../forms/ElementPlace";
import { Fields } from "../../forms/PartFields";
import "../../forms/inspector.css";
import type { AxisView, ElementView, Kind, ParameterForm } from "../../protocol";
import { useStudio } from "../../server/store";
import type { PlotKind } from "../../model/ports";

// The room of the parts that a kind of plot shows.
const SHOWN: Partial<Record<PlotKind, string>> = {
  kernel: "kernels",
  course: "windows",
  space_time: "windows",
};

type PlotParametersProps = {
  element: ElementView;
  kind: PlotKind;
  axes: AxisView[];
  opened: boolean;
  onOpened: (opened: boolean) => void;
};

export function PlotParameters({ element, kind, axes, opened, onOpened }: PlotParametersProps) {
  const kinds = useStudio((state) => state.kinds);
  const record = useStudio((state) => state.document?.record != null);
  const forms = (kinds.get(element.kind)?.parameters ?? []).filter(
    (form) => SHOWN[kind] !== undefined && roomOf(form, kinds) === SHOWN[kind],
  );
  if (record || (forms.length === 0 && axes.length === 0)) {
    return null;
  }
  return (
    <Popover position="bottom-end" width={300} trapFocus opened={opened} onChange={onOpened} withinPortal>
      <Popover.Target>
        <Tooltip label="Edit what this plot shows">
          <ActionIcon size="sm" aria-label="Edit what this plot shows" onClick={() => onOpened(!opened)}>
            <IconPencil size={15} />
          </ActionIcon>
        </Tooltip>
      </Popover.Target>
      <Popover.Dropdown className="plot-parameters">
        <ElementPlace id={element.id}>
          <Fields forms={forms} values={element.values} prefix="" />
        </ElementPlace>
        {axes.map((axis) => (
          <AxisFields key={axis.key} axis={axis} />
        ))}
      </Popover.Dropdown>
    </Popover>
  );
}

// The room of the parts that a parameter has; empty: it has none.
function roomOf(form: ParameterForm, kinds: Map<string, Kind>): string {
  return kinds.get(form.of[0] ?? "")?.room ?? "";
}
