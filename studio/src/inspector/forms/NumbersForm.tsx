// Numbers, each under a name.

import { useState } from "react";

import { AddButton } from "../../widgets/AddButton";
import { words } from "../parameters/part";
import { FormRow, useForm } from "./FormRow";
import { NumberRow } from "./NumberRow";
import type { FormProps } from "./props";
import { RemoveButton } from "./RemoveButton";
import { TextBox } from "./TextBox";

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
