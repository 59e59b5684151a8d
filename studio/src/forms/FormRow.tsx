// The row of a parameter around the control of its form: the way back to the default, and what is wrong.

import type { ReactNode } from "react";

import { ProblemLine } from "../widgets/ProblemLine";
import { ParameterRow } from "./ParameterRow";
import { type Setting, useSetting } from "../actions/setting";
import { usePlace } from "../state/place";
import type { FormProps } from "./props";

export function useForm<T = unknown>({ form, path, value }: FormProps): Setting<T> {
  return useSetting<T>(usePlace().element, path, value as T, form.cost);
}

type FormRowProps = FormProps & {
  setting: Setting;
  inline?: boolean;
  extra?: ReactNode;
  // What follows the row, between it and its problem.
  below?: ReactNode;
  children?: ReactNode;
};

export function FormRow({ setting, below, children, ...row }: FormRowProps) {
  const problem = <ProblemLine problem={setting.problem} />;
  const isAlone = below === undefined;
  return (
    <>
      <ParameterRow {...row} onReset={(standard) => void setting.commit(standard)}>
        {isAlone ? (
          <>
            {children}
            {problem}
          </>
        ) : (
          children
        )}
      </ParameterRow>
      {below}
      {!isAlone && problem}
    </>
  );
}
