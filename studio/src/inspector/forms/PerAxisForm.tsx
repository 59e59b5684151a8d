// One number for all axes, or one for each.

import { UnstyledButton } from "@mantine/core";

import { usePlace } from "../place";
import { ProblemLine } from "../../widgets/ProblemLine";
import { ParameterRow } from "../parameters/ParameterRow";
import { useSetting } from "../parameters/setting";
import { NumberRow } from "./NumberRow";
import type { FormProps } from "./props";

export function PerAxisForm({ form, path, value }: FormProps) {
  const { element, axes } = usePlace();
  const setting = useSetting(element, path, value, form.cost);
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
        <NumberRow form={form} path={path} value={typeof value === "number" ? value : null} extra={choice} />
        <ProblemLine problem={setting.problem} />
      </>
    );
  }
  return (
    <>
      <ParameterRow
        form={form}
        path={path}
        value={value}
        extra={choice}
        onReset={(standard) => void setting.commit(standard)}
      />
      <div className="nested">
        {(value as number[]).map((one, i) => (
          <NumberRow
            key={i}
            form={form}
            path={`${path}.${i}`}
            value={one}
            label={axes[i]?.name ?? String(i)}
          />
        ))}
      </div>
      <ProblemLine problem={setting.problem} />
    </>
  );
}
