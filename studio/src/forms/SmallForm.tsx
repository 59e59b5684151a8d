// A form of a few fields: Enter or its button sends it, Escape or Cancel ends it.

import { Button } from "@mantine/core";
import { type FormEvent, type ReactNode, useState } from "react";

import type { ListedProblem } from "../protocol";
import { ProblemLine } from "../widgets/ProblemLine";

type SmallFormProps = {
  className: string;
  label?: string;
  submit: string;
  ready: boolean;
  // Resolves to what is wrong; to true or null where nothing is, to false where that is shown elsewhere.
  send: () => Promise<boolean | ListedProblem | null>;
  onDone: () => void;
  children: (refused: boolean) => ReactNode;
};

export function SmallForm({ className, label, submit, ready, send, onDone, children }: SmallFormProps) {
  const [problem, setProblem] = useState<ListedProblem | null>(null);
  const onSubmit = async (event: FormEvent) => {
    event.preventDefault();
    const refusal = await send();
    if (refusal === true || refusal === null) {
      onDone();
    } else if (refusal !== false) {
      setProblem(refusal);
    }
  };
  return (
    <form
      className={className}
      aria-label={label}
      onSubmit={(event) => void onSubmit(event)}
      onChange={() => setProblem(null)}
      onKeyDown={(event) => event.key === "Escape" && onDone()}
    >
      {children(problem !== null)}
      <Button size="compact-xs" type="submit" disabled={!ready}>
        {submit}
      </Button>
      <Button size="compact-xs" variant="subtle" color="gray" onClick={onDone}>
        Cancel
      </Button>
      <ProblemLine problem={problem} />
    </form>
  );
}
