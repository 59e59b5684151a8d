// Texts: one, several, names with another one each, and any value as it is typed.

import { IconArrowRight } from "@tabler/icons-react";
import type { ReactNode } from "react";

import type { ParameterForm } from "../protocol";
import { AddButton } from "../widgets/AddButton";
import { fresh, without, words } from "../model/part";
import type { Setting } from "../actions/setting";
import { usePlace } from "../state/place";
import { ChoiceBox } from "../widgets/ChoiceBox";
import { FormRow, useForm } from "./FormRow";
import { NameBox } from "../widgets/NameBox";
import type { FormProps } from "./props";
import { RemoveButton } from "./RemoveButton";
import { TextBox } from "../widgets/TextBox";
import { typedValue, valueText } from "./value";

export function TextForm(props: FormProps) {
  const { form, path, value } = props;
  const setting = useForm(props);
  return (
    <FormRow {...props} setting={setting} inline={form.choices.length > 0}>
      <TextControl
        form={form}
        label={path}
        text={typeof value === "string" ? value : null}
        setting={setting}
        optional={form.optional}
        onText={setting.commit}
      />
    </FormRow>
  );
}

export function TextsForm(props: FormProps) {
  const { form, path, value } = props;
  const setting = useForm(props);
  const names = useNames(form);
  const texts = Array.isArray(value) ? (value as string[]) : typeof value === "string" ? [value] : [];
  const commit = (next: string[]) => setting.commit(next.length === 0 && form.optional ? null : next);
  const free = form.choices[0] ?? names.find((name) => !texts.includes(name)) ?? fresh(texts);
  return (
    <ListRow
      {...props}
      setting={setting}
      lines={texts.map((text, i) => (
        <div className="flow list-line" key={i}>
          <TextControl
            form={form}
            label={`${path} ${i + 1}`}
            text={text}
            setting={setting}
            onText={(next) => commit(texts.with(i, next ?? text))}
          />
          <RemoveButton label={`Remove ${text} from ${path}`} onClick={() => commit(without(texts, i))} />
        </div>
      ))}
      onAdd={() => commit([...texts, free])}
    />
  );
}

export function PairsForm(props: FormProps) {
  const { path, value } = props;
  const setting = useForm(props);
  const pairs = Object.entries((value ?? {}) as Record<string, string>);
  const commit = (next: [string, string][]) => setting.commit(Object.fromEntries(next));
  const name = fresh(pairs.map(([from]) => from));
  return (
    <ListRow
      {...props}
      setting={setting}
      lines={pairs.map(([from, to], i) => (
        <div className="flow list-line" key={from}>
          <TextBox
            label={`${path} name ${i + 1}`}
            value={from}
            onCommit={(typed) => commit(pairs.with(i, [typed, to]))}
            onForget={setting.forget}
          />
          <IconArrowRight className="dim" size={12} />
          <TextBox
            label={`${path} ${from}`}
            value={to}
            onCommit={(typed) => commit(pairs.with(i, [from, typed]))}
            onForget={setting.forget}
          />
          <RemoveButton label={`Remove ${from} from ${path}`} onClick={() => commit(without(pairs, i))} />
        </div>
      ))}
      onAdd={() => commit([...pairs, [name, name]])}
    />
  );
}

export function ValueForm(props: FormProps) {
  const setting = useForm(props);
  return (
    <FormRow {...props} setting={setting} inline>
      <TextBox
        label={props.path}
        value={valueText(props.value)}
        rejected={setting.problem !== null}
        onCommit={(typed) => setting.commit(typedValue(typed))}
        onForget={setting.forget}
      />
    </FormRow>
  );
}

type ListRowProps = FormProps & { setting: Setting; lines: ReactNode[]; onAdd: () => unknown };

function ListRow({ lines, onAdd, ...row }: ListRowProps) {
  return (
    <FormRow {...row} inline={lines.length === 0}>
      {lines}
      {lines.length === 0 && <span className="dim grow">none</span>}
      <AddButton aria-label={`Add to ${words(row.path)}`} onClick={() => void onAdd()} />
    </FormRow>
  );
}

type TextControlProps = {
  form: ParameterForm;
  label: string;
  text: string | null;
  setting: Setting;
  // Whether there may be no text.
  optional?: boolean;
  onText: (text: string | null) => Promise<boolean>;
};

// A list of the few words or the valid names, where there are any.
function TextControl({ form, label, text, setting, optional = false, onText }: TextControlProps) {
  const names = useNames(form);
  const onCommit = (typed: string) => onText(typed === "" && optional ? null : typed);
  if (form.choices.length > 0) {
    const choice = { label, value: text, choices: form.choices, optional };
    return <ChoiceBox {...choice} onCommit={(chosen) => void onText(chosen)} />;
  }
  if (names.length > 0) {
    return <NameBox label={label} value={text ?? ""} names={names} onCommit={onCommit} />;
  }
  return (
    <TextBox
      label={label}
      value={text ?? ""}
      placeholder={optional ? "none" : undefined}
      rejected={setting.problem !== null}
      onCommit={onCommit}
      onForget={setting.forget}
    />
  );
}

function useNames(form: ParameterForm): string[] {
  return usePlace().names?.(form.names ?? "") ?? [];
}
