// A number with its label, which says below what is wrong with it.

import { useState } from "react";

import type { ListedProblem } from "../protocol";
import type { Reply } from "../server/socket";
import { NumberBox, type NumberBoxProps } from "./NumberBox";
import { ProblemLine } from "./ProblemLine";

type OfTheField = "rejected" | "optional" | "onCommit" | "onStep" | "onForget" | "onComplain" | "onLeave";

type NumberFieldProps = Omit<NumberBoxProps, OfTheField> & {
  className?: string;
  set: (value: number) => void | Promise<Reply>;
  // What an empty field means, where it may be empty.
  clear?: () => void | Promise<Reply>;
};

export function NumberField({ className = "", set, clear, ...box }: NumberFieldProps) {
  const [problem, setProblem] = useState<ListedProblem | null>(null);
  const commit = async (number: number | null): Promise<boolean> => {
    const reply = await (number === null ? clear?.() : set(number));
    const refusal = reply?.answer.problems?.[0] ?? null;
    setProblem(refusal);
    return refusal === null;
  };
  return (
    <div className={`number-field ${className}`}>
      <NumberBox
        labelled
        {...box}
        optional={clear !== undefined}
        rejected={problem !== null}
        onCommit={commit}
        onForget={() => setProblem(null)}
        onComplain={setProblem}
      />
      <ProblemLine problem={problem} />
    </div>
  );
}
