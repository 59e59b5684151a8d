// Numbers, each under a name.

import { ActionIcon } from "@mantine/core";
import { IconX } from "@tabler/icons-react";
import { useState } from "react";

import { AddButton } from "../../widgets/AddButton";
import { words } from "../parameters/part";
import { usePlace } from "../place";
import { ProblemLine } from "../../widgets/ProblemLine";
import { ParameterRow } from "../parameters/ParameterRow";
import { useSetting } from "../parameters/setting";
import { NumberRow } from "./NumberRow";
import type { FormProps } from "./props";
import { TextBox } from "./TextBox";

export function NumbersForm({ form, path, value }: FormProps) {
  const { element } = usePlace();
  const setting = useSetting(element, path, value, form.cost);
  const [naming, setNaming] = useState(false);
  const numbers = (value ?? {}) as Record<string, number>;
  const names = Object.keys(numbers);
  const remove = (name: string) =>
    void setting.commit(Object.fromEntries(Object.entries(numbers).filter(([k]) => k !== name)));
  const add = async (name: string) => {
    const taken = name in numbers || (await setting.commit({ ...numbers, [name]: 0 }));
    setNaming(!taken);
    return taken;
  };
  return (
    <>
      <ParameterRow
        form={form}
        path={path}
        value={value}
        inline
        onReset={(standard) => void setting.commit(standard)}
      >
        <span className="dim grow">{names.length === 0 ? "none" : ""}</span>
        <AddButton aria-label={`Add to ${words(path)}`} onClick={() => setNaming(true)} />
      </ParameterRow>
      <div className="nested">
        {names.map((name) => (
          <NumberRow
            key={name}
            form={form}
            path={`${path}.${name}`}
            value={numbers[name] ?? 0}
            label={name}
            extra={
              <ActionIcon size={18} aria-label={`Remove ${name} from ${path}`} onClick={() => remove(name)}>
                <IconX size={13} />
              </ActionIcon>
            }
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
      <ProblemLine problem={setting.problem} />
    </>
  );
}
