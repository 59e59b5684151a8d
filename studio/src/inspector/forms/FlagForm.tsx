// On or off.

import { Switch } from "@mantine/core";

import { usePlace } from "../place";
import { ProblemLine } from "../../widgets/ProblemLine";
import { ParameterRow } from "../parameters/ParameterRow";
import { useSetting } from "../parameters/setting";
import type { FormProps } from "./props";

export function FlagForm({ form, path, value }: FormProps) {
  const { element } = usePlace();
  const setting = useSetting(element, path, value, form.cost);
  return (
    <ParameterRow
      form={form}
      path={path}
      value={value}
      inline
      onReset={(standard) => void setting.commit(standard)}
    >
      <Switch
        size="xs"
        aria-label={path}
        checked={value === true}
        onChange={(event) => void setting.commit(event.currentTarget.checked)}
      />
      <ProblemLine problem={setting.problem} />
    </ParameterRow>
  );
}
