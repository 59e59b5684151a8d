// The parameters of a kind, each by the form that fits its value.

import { memo, use } from "react";

import type { ParameterForm } from "../protocol";
import { useStudio } from "../server/store";
import type { Values } from "../model/values";
import { type FormProps, Forms } from "./props";

type PartFieldsProps = { kind: string; values: unknown; prefix?: string };

export function PartFields({ kind, values, prefix = "" }: PartFieldsProps) {
  const forms = useStudio((state) => state.kinds.get(kind))?.parameters ?? [];
  return <Fields forms={forms} values={values} prefix={prefix} />;
}

type FieldsProps = { forms: ParameterForm[]; values: unknown; prefix: string };

export function Fields({ forms, values, prefix }: FieldsProps) {
  return forms.map((form) => (
    <Parameter
      key={form.name}
      form={form}
      path={`${prefix}${form.name}`}
      value={((values ?? {}) as Values)[form.name] ?? null}
    />
  ));
}

// Only changed values are drawn again: unchanged values are the same objects.
const Parameter = memo(function Parameter(props: FormProps) {
  const Form = use(Forms)?.[props.form.form];
  return Form && <Form {...props} />;
});
