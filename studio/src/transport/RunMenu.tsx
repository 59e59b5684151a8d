// Rarely changed settings: the seed, the time step, how many steps at a time.

import { ActionIcon, Button, Group, Stack } from "@mantine/core";
import { IconAdjustmentsHorizontal, IconDice5 } from "@tabler/icons-react";

import { socket } from "../server/socket";
import { useStudio } from "../server/store";
import { ButtonPopover } from "../widgets/ButtonPopover";
import { NumberField } from "../widgets/NumberField";
import { TipButton } from "../widgets/TipButton";
import { unitText } from "../model/format";
import { MOST_SEED, reset, rollSeed, useNext } from "../actions/run";

const MOST_STEPS = 1_000_000;

export function RunMenu() {
  return (
    <ButtonPopover
      tip="Seed, time step, steps at a time"
      width={340}
      button={(toggle) => (
        <ActionIcon aria-label="Run settings" size={28} onClick={toggle}>
          <IconAdjustmentsHorizontal size={18} />
        </ActionIcon>
      )}
    >
      <Stack gap="sm">
        <Seed />
        <TimeStep />
        <LongestStep />
        <Steps />
      </Stack>
    </ButtonPopover>
  );
}

function Seed() {
  const used = useStudio((state) => state.clock?.seed ?? 0);
  const next = useNext((state) => state.seed);
  return (
    <Group gap={6} align="flex-end" wrap="nowrap">
      <NumberField
        label="Seed of the noise"
        description={
          next === null ? "The same seed gives the same run." : "Takes effect with the next reset."
        }
        value={next ?? used}
        lower={0}
        upper={MOST_SEED}
        whole
        set={(value) => useNext.setState({ seed: value === used ? null : value })}
      />
      <TipButton tip="New seed" variant="default" size={30} onClick={rollSeed}>
        <IconDice5 size={17} />
      </TipButton>
      <Button size="xs" variant={next === null ? "default" : "filled"} onClick={() => void reset()}>
        Reset
      </Button>
    </Group>
  );
}

function TimeStep() {
  const dt = useStudio((state) => state.clock?.dt ?? state.document?.dt ?? 1);
  const unit = useStudio((state) => unitText(state.document?.time_unit ?? ""));
  return (
    <NumberField
      label="Time step dt"
      description="Must be small compared with every time constant. The state is kept."
      value={dt}
      unit={unit}
      set={(value) => socket.ask({ type: "describe", dt: value })}
    />
  );
}

function LongestStep() {
  const longest = useStudio((state) => state.clock?.longest ?? null);
  const unit = useStudio((state) => unitText(state.document?.time_unit ?? ""));
  const lengthen = (value: number | null) => socket.ask({ type: "lengthen", longest: value });
  return (
    <NumberField
      label="Longest step, where time is short"
      description="Empty: the step is constant, and a slow computer falls behind."
      value={longest}
      unit={unit}
      placeholder="dt stays"
      set={lengthen}
      clear={() => lengthen(null)}
    />
  );
}

function Steps() {
  const steps = useNext((state) => state.steps);
  return (
    <NumberField
      label="Steps at a time"
      description="For the step button and the key “.”"
      value={steps}
      lower={1}
      upper={MOST_STEPS}
      whole
      set={(value) => useNext.setState({ steps: value })}
    />
  );
}
