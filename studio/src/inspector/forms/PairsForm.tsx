// Names, each with another one.

import { ActionIcon } from "@mantine/core";
import { IconArrowRight, IconX } from "@tabler/icons-react";

import { AddButton } from "../../widgets/AddButton";
import { fresh, words } from "../parameters/part";
import { usePlace } from "../place";
import { ProblemLine } from "../../widgets/ProblemLine";
import { ParameterRow } from "../parameters/ParameterRow";
import { useSetting } from "../parameters/setting";
import type { FormProps } from "./props";
import { TextBox } from "./TextBox";

export function PairsForm({ form, path, value }: FormProps) {
  const { element } = usePlace();
  const setting = useSetting(element, path, value, form.cost);
  const pairs = Object.entries((value ?? {}) as Record<string, string>);
  const commit = (next: [string, string][]) => setting.commit(Object.fromEntries(next));
  const put = (i: number, pair: [string, string]) => commit(pairs.map((old, k) => (k === i ? pair : old)));
  const add = () => {
    const name = fresh(pairs.map(([from]) => from));
    void commit([...pairs, [name, name]]);
  };
  return (
    <ParameterRow
      form={form}
      path={path}
      value={value}
      inline={pairs.length === 0}
      onReset={(standard) => void setting.commit(standard)}
    >
      {pairs.map(([from, to], i) => (
        <div className="list-line" key={from}>
          <TextBox
            label={`${path} name ${i + 1}`}
            value={from}
            onCommit={(typed) => put(i, [typed, to])}
            onForget={setting.forget}
          />
          <IconArrowRight className="dim" size={12} />
          <TextBox
            label={`${path} ${from}`}
            value={to}
            onCommit={(typed) => put(i, [from, typed])}
            onForget={setting.forget}
          />
          <ActionIcon
            size={20}
            aria-label={`Remove ${from} from ${path}`}
            onClick={() => void commit(pairs.filter((_, k) => k !== i))}
          >
            <IconX size={13} />
          </ActionIcon>
        </div>
      ))}
      {pairs.length === 0 && <span className="dim grow">none</span>}
      <AddButton aria-label={`Add to ${words(path)}`} onClick={add} />
      <ProblemLine problem={setting.problem} />
    </ParameterRow>
  );
}
