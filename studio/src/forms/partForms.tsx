// Parts: one of a kind that can be chosen, and a list of parts, such as kernels: add, remove, move, and the
// parameters of each below its line. Where no list and an empty one differ, as always and never, both are
// choices.

import { Menu, UnstyledButton } from "@mantine/core";
import { useState } from "react";
import { IconChevronDown, IconChevronRight, IconTrash } from "@tabler/icons-react";

import { useStudio } from "../server/store";
import { kindOf, moved, recast, summary, without, words } from "../model/part";
import { ChoiceBox } from "../widgets/ChoiceBox";
import { FormRow, useForm } from "./FormRow";
import { PartFields } from "./PartFields";
import type { FormProps } from "./props";
import type { Values } from "../model/values";
import { AddButton } from "../widgets/AddButton";
import { MenuList } from "../widgets/MenuList";
import { listChoices, listState } from "./listState";
import type { ParameterForm } from "../protocol";
import { DotsMenu } from "../widgets/DotsMenu";
import { MoveItems } from "../widgets/MoveItems";

export function PartForm(props: FormProps) {
  const { form, path, value } = props;
  const setting = useForm(props);
  const kinds = useStudio((state) => state.kinds);
  const kind = kindOf(kinds, value);
  return (
    <>
      <FormRow {...props} setting={setting} inline>
        <ChoiceBox
          label={path}
          value={kind?.name ?? null}
          choices={form.of.map((name) => ({ value: name, label: kinds.get(name)?.title ?? name }))}
          optional={form.optional}
          onCommit={(name) => void setting.commit(name === null ? null : recast(kinds, name, value))}
        />
      </FormRow>
      {kind !== undefined && (
        <div className="nested">
          <PartFields kind={kind.name} values={value} prefix={`${path}.`} />
        </div>
      )}
    </>
  );
}

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
      <Menu position="bottom-end" classNames={{ dropdown: "compact-menu" }}>
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

type PartItemProps = {
  form: ParameterForm;
  path: string;
  parts: Values[];
  index: number;
  folded: boolean;
  onFold: () => void;
  commit: (parts: Values[]) => void;
};

function PartItem({ form, path, parts, index, folded, onFold, commit }: PartItemProps) {
  const part = parts[index] ?? {};
  const kinds = useStudio((state) => state.kinds);
  const kind = kindOf(kinds, part);
  const title = kind?.title ?? String(part["kind"]);
  const others = form.of.filter((name) => name !== kind?.name);
  return (
    <section className="part-item" aria-label={path}>
      <div className="flow part-line">
        <UnstyledButton
          className="flow part-fold"
          aria-expanded={!folded}
          aria-label={`${title}, ${path}`}
          onClick={onFold}
        >
          {folded ? <IconChevronRight size={13} /> : <IconChevronDown size={13} />}
          <span className="part-title">{title}</span>
          {folded && <span className="dim one-line">{summary(kinds, part)}</span>}
        </UnstyledButton>
        <DotsMenu label={`More for ${path}`}>
          <MoveItems
            place={{ index, count: parts.length }}
            onMove={(to) => commit(moved(parts, index, to))}
          />
          <Menu.Item leftSection={<IconTrash size={14} />} onClick={() => commit(without(parts, index))}>
            Remove
          </Menu.Item>
          {others.length > 0 && <Menu.Label>Replace by</Menu.Label>}
          {others.map((name) => (
            <Menu.Item key={name} onClick={() => commit(parts.with(index, recast(kinds, name, part)))}>
              {kinds.get(name)?.title ?? name}
            </Menu.Item>
          ))}
        </DotsMenu>
      </div>
      {!folded && (
        <div className="nested">
          <PartFields kind={String(part["kind"])} values={part} prefix={`${path}.`} />
        </div>
      )}
    </section>
  );
}
