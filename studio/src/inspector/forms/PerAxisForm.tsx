// One number for all axes, or one for each.

import { UnstyledButton } from "@mantine/core";

import { ProblemLine } from "../../widgets/ProblemLine";
import { usePlace } from "../place";
import { FormRow, useForm } from "./FormRow";
import { NumberForm, NumberRow } from "./NumberRow";
import type { FormProps } from "./props";

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
