// Rarely changed settings: the seed, the time step, how many steps at a time.

import { ActionIcon, Button, Group, NumberInput, Popover, Stack, Tooltip } from "@mantine/core";
import { IconAdjustmentsHorizontal, IconDice5 } from "@tabler/icons-react";
import { useEffect, useRef, useState } from "react";

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

function TimeStep() {
  const dt = useStudio((state) => state.clock?.dt ?? state.document?.dt ?? 1);
  const unit = useStudio((state) => unitText(state.document?.time_unit ?? ""));
  const [value, setValue] = useState<number | string>(dt);
  const asked = useRef(dt);
  useEffect(() => {
    // What was typed since stays: the person is ahead of the answer.
    const known = asked.current;
    setValue((now) => (now === known ? dt : now));
    asked.current = dt;
  }, [dt]);
  const send = async () => {
    if (typeof value !== "number") {
      setValue(dt);
    } else if (value !== dt && value !== asked.current) {
      asked.current = value;
      const answer = await request({ type: "describe", dt: value });
      if ((answer.problems ?? []).length > 0) {
        asked.current = dt;
        setValue(dt);
      }
    }
  };
  return (
    <div>
      <NumberInput
        label="Time step dt"
        size="xs"
        value={value}
        onChange={setValue}
        onBlur={() => void send()}
        min={0}
        hideControls
        onKeyDown={(event) => event.key === "Enter" && void send()}
        suffix={unit === "" ? "" : ` ${unit}`}
      />
      <Hint>Must be small compared with every time constant. The state is kept.</Hint>
    </div>
  );
}

function LongestStep() {
  const longest = useStudio((state) => state.clock?.longest ?? null);
  const unit = useStudio((state) => unitText(state.document?.time_unit ?? ""));
  const [value, setValue] = useState<number | string>(longest ?? "");
  useEffect(() => setValue(longest ?? ""), [longest]);
  const send = async () => {
    const wanted = typeof value === "number" ? value : null;
    if (wanted !== longest) {
      const answer = await request({ type: "lengthen", longest: wanted });
      if ((answer.problems ?? []).length > 0) {
        setValue(longest ?? "");
      }
    }
  };
  return (
    <div>
      <NumberInput
        label="Longest step, where time is short"
        size="xs"
        value={value}
        onChange={setValue}
        onBlur={() => void send()}
        min={0}
        hideControls
        placeholder="dt stays"
        onKeyDown={(event) => event.key === "Enter" && void send()}
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
  return <div style={{ marginTop: 3, fontSize: 11, color: "var(--text-dim)" }}>{children}</div>;
}
