// A number, and the row of a single one: of a parameter, of one axis, of one name in a table.

import type { ReactNode } from "react";

import { NumberControl } from "../numbers/NumberControl";
import { usePlace, useDriver } from "../place";
import { axesAt, sliderRange } from "../numbers/sliderRange";
import { ParameterRow } from "../parameters/ParameterRow";
import { useSetting } from "../parameters/setting";
import { unitText } from "../numbers/unit";
import type { FormProps } from "./props";

// Longer units are beside the name.
const MOST_UNIT = 5;

type NumberRowProps = Omit<FormProps, "value"> & { value: number | null; label?: string; extra?: ReactNode };

export function NumberForm({ value, ...row }: FormProps & Pick<NumberRowProps, "extra">) {
  return <NumberRow {...row} value={typeof value === "number" ? value : null} />;
}

export function NumberRow({ form, path, value, label, extra }: NumberRowProps) {
  const { element, axes, own, timeUnit } = usePlace();
  const driver = useDriver(path);
  const setting = useSetting<number | null>(
    driver === undefined ? element : "",
    driver?.name ?? path,
    driver?.value ?? value,
    form.cost,
  );
  const range = sliderRange(form, setting.value, { path, axes, own });
  const unit = unitText(form.unit, timeUnit, axesAt(axes, form, path));
  return (
    <ParameterRow
      form={form}
      path={path}
      value={setting.value}
      label={label}
      leaf={value !== null}
      inline
      driver={driver}
      extra={extra}
      unit={unit.length > MOST_UNIT ? unit : ""}
      onReset={(standard) => void setting.commit(standard as number | null)}
    >
      <NumberControl
        label={path}
        setting={setting}
        range={range}
        rangeKey={`${element} ${path} ${axes.map((axis) => axis.key).join(" ")}`}
        unit={unit.length > MOST_UNIT ? "" : unit}
        optional={form.optional}
      />
    </ParameterRow>
  );
}
