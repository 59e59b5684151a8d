// Numbers: one, one for all axes or for each, and several that have names.

import { type ReactNode, useState } from "react";
import { UnstyledButton } from "@mantine/core";

import { NumberControl } from "./NumberControl";
import { useDriver, usePlace } from "../state/place";
import { axesAt, sliderRange } from "../model/sliderRange";
import { ParameterRow } from "./ParameterRow";
import { useSetting } from "../actions/setting";
import { unitText } from "../model/unit";
import type { FormProps } from "./props";
import { ProblemLine } from "../widgets/ProblemLine";
import { FormRow, useForm } from "./FormRow";
import { AddButton } from "../widgets/AddButton";
import { words } from "../model/part";
import { RemoveButton } from "./RemoveButton";
import { TextBox } from "../widgets/TextBox";

// Longer units are beside the name.
const MOST_UNIT = 5;

type NumberRowProps = Omit<FormProps, "value"> & { value: number | null; label?: string; extra?: ReactNode };

export function NumberForm({ value, ...row }: FormProps & Pick<NumberRowProps, "extra">) {
  return <NumberRow {...row} value={typeof value === "number" ? value : null} />;
}

function NumberRow({ form, path, value, label, extra }: NumberRowProps) {
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

export function PerAxisForm(props: FormProps) {
  const { form, path, value } = props;
  const { axes } = usePlace();
  const setting = useForm(props);
  const each = Array.isArray(value);
  const toggle = () => void setting.commit(each ? (value as unknown[])[0] : axes.map(() => value));
  const choice = (axes.length > 1 || each) && value !== null && (
    <UnstyledButton
      className="each-axis"
      aria-label={`${path} for each axis`}
      aria-pressed={each}
      onClick={toggle}
    >
      each axis
    </UnstyledButton>
  );
  if (!each) {
    return (
      <>
        <NumberForm {...props} extra={choice} />
        <ProblemLine problem={setting.problem} />
      </>
    );
  }
  const rows = (
    <div className="nested">
      {(value as number[]).map((one, i) => (
        <NumberRow key={i} form={form} path={`${path}.${i}`} value={one} label={axes[i]?.name ?? String(i)} />
      ))}
    </div>
  );
  return <FormRow {...props} setting={setting} extra={choice} below={rows} />;
}

export function NumbersForm(props: FormProps) {
  const { form, path, value } = props;
  const setting = useForm(props);
  const [naming, setNaming] = useState(false);
  const numbers = (value ?? {}) as Record<string, number>;
  const names = Object.keys(numbers);
  const remove = (name: string) =>
    setting.commit(Object.fromEntries(Object.entries(numbers).filter(([k]) => k !== name)));
  const add = async (name: string) => {
    const taken = name in numbers || (await setting.commit({ ...numbers, [name]: 0 }));
    setNaming(!taken);
    return taken;
  };
  const rows = (
    <div className="nested">
      {names.map((name) => (
        <NumberRow
          key={name}
          form={form}
          path={`${path}.${name}`}
          value={numbers[name] ?? 0}
          label={name}
          extra={<RemoveButton label={`Remove ${name} from ${path}`} onClick={() => remove(name)} />}
        />
      ))}
      {naming && (
        <div onKeyDown={(event) => event.key === "Escape" && setNaming(false)}>
          <TextBox
            label={`New name in ${path}`}
            value=""
            placeholder="name"
            autoFocus
            rejected={setting.problem !== null}
            onCommit={add}
            onForget={setting.forget}
          />
        </div>
      )}
    </div>
  );
  return (
    <FormRow {...props} setting={setting} inline below={rows}>
      <span className="dim grow">{names.length === 0 ? "none" : ""}</span>
      <AddButton aria-label={`Add to ${words(path)}`} onClick={() => setNaming(true)} />
    </FormRow>
  );
}
