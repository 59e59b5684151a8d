// Rarely changed settings: the seed, the time step, how many steps at a time.

import { ActionIcon, Button, Group, NumberInput, Popover, Stack, Tooltip } from "@mantine/core";
import { IconAdjustmentsHorizontal, IconDice5 } from "@tabler/icons-react";
import { useEffect, useRef, useState } from "react";

import type { Answer } from "../protocol";
import { request } from "../socket";
import { useStudio } from "../store";
import { unitText } from "./format";
import { MOST_SEED, reset, rollSeed, useNext } from "./run";

const MOST_STEPS = 1_000_000;

export function RunMenu() {
  const [opened, setOpened] = useState(false);
  return (
    <Popover
      opened={opened}
      onChange={setOpened}
      position="bottom"
      withArrow
      shadow="md"
      trapFocus
      returnFocus
    >
      <Popover.Target>
        <Tooltip label="Seed, time step, steps at a time" disabled={opened}>
          <ActionIcon aria-label="Run settings" size={28} onClick={() => setOpened(!opened)}>
            <IconAdjustmentsHorizontal size={18} />
          </ActionIcon>
        </Tooltip>
      </Popover.Target>
      <Popover.Dropdown p="md" w={300}>
        <Stack gap="sm">
          <Seed />
          <TimeStep />
          <LongestStep />
          <Steps />
        </Stack>
      </Popover.Dropdown>
    </Popover>
  );
}

function Seed() {
  const used = useStudio((state) => state.clock?.seed ?? 0);
  const next = useNext((state) => state.seed);
  const set = (value: number | string) => {
    if (typeof value === "number") {
      useNext.setState({ seed: value === used ? null : value });
    }
  };
  return (
    <div>
      <Group gap={6} align="flex-end" wrap="nowrap">
        <NumberInput
          label="Seed of the noise"
          size="xs"
          flex={1}
          value={next ?? used}
          onChange={set}
          min={0}
          max={MOST_SEED}
          allowDecimal={false}
          allowNegative={false}
          data-autofocus
        />
        <Tooltip label="New seed">
          <ActionIcon variant="default" size={30} aria-label="New seed" onClick={rollSeed}>
            <IconDice5 size={17} />
          </ActionIcon>
        </Tooltip>
        <Button size="xs" variant={next === null ? "default" : "filled"} onClick={() => void reset()}>
          Reset
        </Button>
      </Group>
      <Hint>{next === null ? "The same seed gives the same run." : "Takes effect with the next reset."}</Hint>
    </div>
  );
}

// A value that a person types and sends; a refused one goes back. What was typed since stays when an answer
// arrives: the person is ahead of it.
function useTyped<T extends number | string>(known: T, ask: (wanted: T) => Promise<Answer>) {
  const [value, setValue] = useState<number | string>(known);
  const asked = useRef<T>(known);
  const latest = useRef<T>(known);
  useEffect(() => {
    const before = asked.current;
    setValue((now) => (now === before ? known : now));
    asked.current = latest.current = known;
  }, [known]);
  const send = async (wanted: T) => {
    if (wanted !== asked.current) {
      asked.current = wanted;
      const answer = await ask(wanted);
      if ((answer.problems ?? []).length > 0) {
        // not the value when it was asked: another one may have arrived since
        asked.current = latest.current;
        setValue(latest.current);
      }
    }
  };
  return { value, setValue, send };
}

function TimeStep() {
  const dt = useStudio((state) => state.clock?.dt ?? state.document?.dt ?? 1);
  const unit = useStudio((state) => unitText(state.document?.time_unit ?? ""));
  const { value, setValue, send } = useTyped(dt, (wanted) => request({ type: "describe", dt: wanted }));
  const done = () => (typeof value === "number" ? send(value) : setValue(dt));
  return (
    <div>
      <NumberInput
        label="Time step dt"
        size="xs"
        value={value}
        onChange={setValue}
        onBlur={() => void done()}
        min={0}
        onKeyDown={(event) => event.key === "Enter" && void done()}
        suffix={unit === "" ? "" : ` ${unit}`}
      />
      <Hint>Must be small compared with every time constant. The state is kept.</Hint>
    </div>
  );
}

function LongestStep() {
  const longest = useStudio((state) => state.clock?.longest ?? null);
  const unit = useStudio((state) => unitText(state.document?.time_unit ?? ""));
  const { value, setValue, send } = useTyped<number | "">(longest ?? "", (wanted) =>
    request({ type: "lengthen", longest: wanted === "" ? null : wanted }),
  );
  const done = () => send(typeof value === "number" ? value : "");
  return (
    <div>
      <NumberInput
        label="Longest step, where time is short"
        size="xs"
        value={value}
        onChange={setValue}
        onBlur={() => void done()}
        min={0}
        placeholder="dt stays"
        onKeyDown={(event) => event.key === "Enter" && void done()}
        suffix={unit === "" ? "" : ` ${unit}`}
      />
      <Hint>Empty: the step is constant, and a slow computer falls behind.</Hint>
    </div>
  );
}

function Steps() {
  const steps = useNext((state) => state.steps);
  return (
    <div>
      <NumberInput
        label="Steps at a time"
        size="xs"
        value={steps}
        min={1}
        max={MOST_STEPS}
        allowDecimal={false}
        clampBehavior="strict"
        onChange={(value) => typeof value === "number" && value >= 1 && useNext.setState({ steps: value })}
      />
      <Hint>For the step button and the key “.”</Hint>
    </div>
  );
}

function Hint({ children }: { children: string }) {
  return <div style={{ marginTop: 3, fontSize: 11, color: "var(--dim)" }}>{children}</div>;
}
