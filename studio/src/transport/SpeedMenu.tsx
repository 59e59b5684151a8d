// How fast the run is asked to go: from slow motion to as fast as possible.

import { Button, Slider, Text } from "@mantine/core";
import { IconGauge } from "@tabler/icons-react";
import { type ComponentProps, useEffect, useState } from "react";

import { request } from "../server/socket";
import { useStudio } from "../server/store";
import { ButtonPopover } from "../widgets/ButtonPopover";
import { speedText } from "../model/format";
import { SPEEDS, stopOf } from "./speeds";

const LAST = SPEEDS.length - 1;
const MARKS = [0, 3, 6, 9, LAST].map((value) => ({ value, label: speedText(SPEEDS[value] ?? null) }));

// How Mantine finds what to focus when the popover opens.
const AUTOFOCUS: ComponentProps<"div"> & { "data-autofocus": true } = { "data-autofocus": true };

export function SpeedMenu() {
  const speed = useStudio((state) => (state.clock === null ? 1 : state.clock.speed));
  const said = stopOf(speed);
  const [stop, setStop] = useState(said);
  useEffect(() => setStop(said), [said]);
  const choose = (next: number) => {
    setStop(next);
    void request({ type: "speed", factor: SPEEDS[next] ?? null });
  };
  return (
    <ButtonPopover
      tip="Speed: simulated time in relation to real time"
      width={{ base: 340, sm: 410 }}
      button={(toggle) => (
        <Button
          variant="default"
          size="compact-sm"
          w={{ base: 62, sm: 76 }}
          px={{ base: 3, sm: 6 }}
          fw={500}
          leftSection={<IconGauge size={15} />}
          className="numbers"
          aria-label={`Speed: ${speedText(speed)}`}
          onClick={toggle}
        >
          {speedText(speed)}
        </Button>
      )}
    >
      <Text size="xs" fw={600} mb={6}>
        Speed
      </Text>
      <Slider
        value={stop}
        onChange={choose}
        min={0}
        max={LAST}
        step={1}
        marks={MARKS}
        label={(value) => speedText(SPEEDS[value] ?? null)}
        thumbLabel="Speed"
        thumbProps={AUTOFOCUS}
        size="sm"
        mx={12}
        mb="lg"
      />
      <Text size="xs" c="dimmed" mt="xl" mb={4}>
        1× is real time, less is slow motion, max is as fast as this computer can.
      </Text>
    </ButtonPopover>
  );
}
