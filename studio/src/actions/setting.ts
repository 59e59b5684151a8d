// The state of a parameter in a control: the value of the server, or the local value during a drag, and the
// error of the last change.

import { useCallback, useEffect, useMemo, useRef, useState } from "react";

import { Held } from "../server/held";
import type { Answer, ParameterForm, ListedProblem } from "../protocol";
import { socket } from "../server/socket";
import { noteChange } from "../widgets/CostMark";
import { usePlace } from "../state/place";
import { useLatest } from "../widgets/useLatest";

export type Setting<T = unknown> = {
  value: T;
  problem: ListedProblem | null;
  // Sends a value at once; true if it was accepted.
  commit: (value: T) => Promise<boolean>;
  // A value while a pointer drags, and the end of the drag.
  move: (value: T) => void;
  end: () => void;
  // A value by key.
  nudge: (value: T) => void;
  forget: () => void;
};

export type SendSetting = (path: string, value: unknown, gesture: number) => Promise<Answer>;

// `element` is empty for a document parameter. A value that recompiles the program is sent when the drag
// ends, not on the way. `sendTo`: where a number goes that is none of these.
export function useSetting<T>(
  element: string,
  parameter: string,
  stored: T,
  cost: ParameterForm["cost"],
  sendTo?: SendSetting,
): Setting<T> {
  const [own, setOwn] = useState<{ value: T } | null>(null);
  const [problem, setProblem] = useState<ListedProblem | null>(null);
  const latest = useRef<{ value: T } | null>(null);

  const { send: placed } = usePlace();
  const place = useLatest(sendTo ?? placed);
  const send = useCallback(
    async (value: T, gesture: number): Promise<Answer> => {
      if (place.current !== undefined) {
        const answer = await place.current(parameter, value, gesture);
        setProblem(answer.problems?.[0] ?? null);
        return answer;
      }
      noteChange(element, parameter);
      const { answer } = await socket.ask({ type: "set", element, parameter, value, gesture });
      setProblem(answer.problems?.[0] ?? null);
      return answer;
    },
    [element, parameter, place],
  );
  const held = useMemo(() => new Held<T>(send, (value) => setOwn(value === null ? null : { value })), [send]);
  useEffect(() => () => held.release(), [held]);

  const late = cost === "recompile";
  const move = useCallback(
    (value: T) => {
      if (late) {
        latest.current = { value };
        setOwn({ value });
      } else {
        held.move(value);
      }
    },
    [held, late],
  );
  const end = useCallback(() => {
    const last = latest.current;
    latest.current = null;
    if (last !== null) {
      held.move(last.value);
    }
    held.release();
  }, [held]);
  const nudge = useCallback((value: T) => held.nudge(value), [held]);
  const commit = useCallback(
    async (value: T) => ((await send(value, 0)).problems ?? []).length === 0,
    [send],
  );
  const forget = useCallback(() => setProblem(null), []);

  return { value: own === null ? stored : own.value, problem, commit, move, end, nudge, forget };
}
