// On or off.

import { Switch } from "@mantine/core";

import { FormRow, useForm } from "./FormRow";
import type { FormProps } from "./props";

export function FlagForm(props: FormProps) {
  const setting = useForm(props);
  return (
    <FormRow {...props} setting={setting} inline>
      <Switch
        aria-label={props.path}
        checked={props.value === true}
        onChange={(event) => void setting.commit(event.currentTarget.checked)}
      />
    </FormRow>
  );
}
