// A list of parts, such as kernels: add, remove, move, and the parameters of each below its line. Where no
// list and an empty one differ, as always and never, both are choices.

import { Menu } from "@mantine/core";
import { useState } from "react";

import { useStudio } from "../../store";
import type { Values } from "../../values";
import { AddButton } from "../../widgets/AddButton";
import { MenuList } from "../../widgets/MenuList";
import { words } from "../parameters/part";
import { ChoiceBox } from "./ChoiceBox";
import { FormRow, useForm } from "./FormRow";
import { listChoices, listState } from "./listState";
import { PartItem } from "./PartItem";
import type { FormProps } from "./props";

export function PartsForm(props: FormProps) {
  const { form, path, value } = props;
  const setting = useForm(props);
  const kinds = useStudio((state) => state.kinds);
  const [folded, setFolded] = useState<number[]>([]);
  const parts = Array.isArray(value) ? (value as Values[]) : [];
  const commit = (next: unknown[] | null) => void setting.commit(next);
  const fold = (i: number) =>
    setFolded((old) => (old.includes(i) ? old.filter((k) => k !== i) : [...old, i]));
  const items = parts.map((part, i) => (
    <PartItem
      key={`${i} ${String(part["kind"])}`}
      form={form}
      path={`${path}.${i}`}
      parts={parts}
      index={i}
      folded={folded.includes(i)}
      onFold={() => fold(i)}
      commit={commit}
    />
  ));
  return (
    <FormRow {...props} setting={setting} inline below={items}>
      <ListChoice form={form} path={path} value={value} onCommit={commit} />
      <Menu position="bottom-end" shadow="md" classNames={{ dropdown: "compact-menu" }}>
        <Menu.Target>
          <AddButton aria-label={`Add to ${words(path)}`} />
        </Menu.Target>
        <MenuList>
          {form.of.map((name) => (
            <Menu.Item
              key={name}
              onClick={() => commit([...parts, kinds.get(name)?.example ?? { kind: name }])}
            >
              {kinds.get(name)?.title ?? name}
            </Menu.Item>
          ))}
        </MenuList>
      </Menu>
    </FormRow>
  );
}

type ListChoiceProps = FormProps & { onCommit: (next: [] | null) => void };

function ListChoice({ form, path, value, onCommit }: ListChoiceProps) {
  const state = listState(value);
  const choices = listChoices(form, state);
  if (choices.length === 0) {
    return <span className="dim grow">{state === "listed" ? "" : "none"}</span>;
  }
  return (
    <ChoiceBox
      label={`Choice of ${words(path)}`}
      value={state}
      choices={choices}
      onCommit={(next) => {
        if (next === "absent" || next === "empty") {
          onCommit(next === "absent" ? null : []);
        }
      }}
    />
  );
}
