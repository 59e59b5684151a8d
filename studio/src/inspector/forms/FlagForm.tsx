// On or off.

import { Switch } from "@mantine/core";

import { usePlace } from "../place";
import { ProblemLine } from "../ProblemLine";
import { Row } from "../Row";
import { useSetting } from "../setting";
import type { FormProps } from "./props";

export function FlagForm({ form, path, value }: FormProps) {
  const { element } = usePlace();
  const setting = useSetting(element, path, value, form.cost);
  return (
    <Row form={form} path={path} value={value} inline onReset={(standard) => void setting.commit(standard)}>
      <Switch
        size="xs"
        aria-label={path}
        checked={value === true}
        onChange={(event) => void setting.commit(event.currentTarget.checked)}
      />
      <ProblemLine problem={setting.problem} />
    </Row>
  );
}
