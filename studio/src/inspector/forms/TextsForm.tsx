// Several texts, or several of a few words.

import { ActionIcon } from "@mantine/core";
import { IconX } from "@tabler/icons-react";

import { AddButton } from "../../widgets/AddButton";
import { fresh, without, words } from "../parameters/part";
import { usePlace } from "../place";
import { ProblemLine } from "../../widgets/ProblemLine";
import { ParameterRow } from "../parameters/ParameterRow";
import { useSetting } from "../parameters/setting";
import { ChoiceBox } from "./ChoiceBox";
import { NameBox } from "./NameBox";
import type { FormProps } from "./props";
import { TextBox } from "./TextBox";

export function TextsForm({ form, path, value }: FormProps) {
  const { element, names } = usePlace();
  const setting = useSetting(element, path, value, form.cost);
  const texts = Array.isArray(value) ? (value as string[]) : typeof value === "string" ? [value] : [];
  const known = names?.(form.names ?? "") ?? [];
  const few = form.choices.length > 0;
  const commit = (next: string[]) => setting.commit(next.length === 0 && form.optional ? null : next);
  const put = (i: number, text: string) => commit(texts.map((old, k) => (k === i ? text : old)));
  const add = () =>
    void commit([...texts, form.choices[0] ?? known.find((name) => !texts.includes(name)) ?? fresh(texts)]);
  return (
    <ParameterRow
      form={form}
      path={path}
      value={value}
      inline={texts.length === 0}
      onReset={(standard) => void setting.commit(standard)}
    >
      {texts.map((text, i) => (
        <div className="list-line" key={i}>
          {few ? (
            <ChoiceBox
              label={`${path} ${i + 1}`}
              value={text}
              choices={form.choices}
              onCommit={(chosen) => void put(i, chosen ?? text)}
            />
          ) : known.length > 0 ? (
            <NameBox
              label={`${path} ${i + 1}`}
              value={text}
              names={known}
              onCommit={(typed) => put(i, typed)}
            />
          ) : (
            <TextBox
              label={`${path} ${i + 1}`}
              value={text}
              onCommit={(typed) => put(i, typed)}
              onForget={setting.forget}
            />
          )}
          <ActionIcon
            size={20}
            aria-label={`Remove ${text} from ${path}`}
            onClick={() => void commit(without(texts, i))}
          >
            <IconX size={13} />
          </ActionIcon>
        </div>
      ))}
      {texts.length === 0 && <span className="dim grow">none</span>}
      <AddButton aria-label={`Add to ${words(path)}`} onClick={add} />
      <ProblemLine problem={setting.problem} />
    </ParameterRow>
  );
}
