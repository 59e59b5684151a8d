// The choice of what the next record holds: ports to tick, the plotted ones at first, and how often they are
// sampled.

import { ActionIcon, Button, Checkbox, ScrollArea, Stack, Text, TextInput } from "@mantine/core";
import { IconChevronDown } from "@tabler/icons-react";
import { useState } from "react";

import { plottedPorts } from "../actions/openPlot";
import type { RecordedPort } from "../protocol";
import { useStudio } from "../server/store";
import { ButtonPopover } from "../widgets/ButtonPopover";
import { NumberField } from "../widgets/NumberField";
import { countText, unitText } from "../model/format";
import { findPorts, isIn, portName, toggled, useRecordChoice } from "./recordChoice";

// More ports than MANY have a search; at most MOST rows are listed.
const MANY = 8;
const MOST = 60;

export function RecordMenu({ disabled }: { disabled: boolean }) {
  return (
    <ButtonPopover
      tip="Choose ports and interval of the record"
      width={300}
      button={(toggle) => (
        <ActionIcon
          aria-label="What to record"
          size={28}
          w={24}
          miw={24}
          disabled={disabled}
          onClick={toggle}
        >
          <IconChevronDown size={13} />
        </ActionIcon>
      )}
    >
      <Choice />
    </ButtonPopover>
  );
}

function Choice() {
  const document = useStudio((state) => state.document);
  const unit = unitText(document?.time_unit ?? "");
  const { ports, every } = useRecordChoice();
  const [search, setSearch] = useState("");
  const elements = document?.elements ?? [];
  const ticked = ports ?? plottedPorts();
  // Ports that were ticked while the list is open stay where they are.
  const [first] = useState(ticked);
  const found = findPorts(elements, first, search);
  const paths = new Map(elements.map((element) => [element.id, element]));
  const count = ticked.filter(({ element }) => paths.has(element)).length;
  const choose = (next: RecordedPort[] | null) => useRecordChoice.setState({ ports: next, every });
  const sample = (next: number | null) => useRecordChoice.setState({ ports, every: next });
  return (
    <Stack gap={8}>
      {findPorts(elements, [], "").length > MANY && (
        <TextInput
          placeholder="Find a port"
          aria-label="Find a port to record"
          value={search}
          onChange={(event) => setSearch(event.currentTarget.value)}
          data-autofocus
        />
      )}
      <ScrollArea.Autosize mah={240} type="auto">
        <Stack gap={5} pr={10} role="group" aria-label="Ports to record">
          {found.slice(0, MOST).map((port) => {
            const element = paths.get(port.element);
            const name = element === undefined ? "" : portName(element, port.port);
            return (
              <Checkbox
                key={name}
                label={name}
                title={name}
                checked={isIn(ticked, port)}
                onChange={() => choose(toggled(ticked, port))}
              />
            );
          })}
        </Stack>
        {found.length > MOST && <Text className="fine">{found.length - MOST} more: type to find them</Text>}
        {found.length === 0 && <Text className="fine">No port has this name.</Text>}
      </ScrollArea.Autosize>
      <Text className="fine">
        {count === 0
          ? "None is ticked: the activation of every field is recorded."
          : `${countText(count)} ${count === 1 ? "port" : "ports"}`}
      </Text>
      <Button
        size="compact-xs"
        variant="default"
        style={{ alignSelf: "flex-start" }}
        onClick={() => choose(null)}
      >
        Tick what is plotted
      </Button>
      <NumberField
        label="Sampling interval"
        description="A multiple of the time step. Empty: every step."
        value={every}
        lower={0}
        unit={unit}
        placeholder="every step"
        set={(value) => sample(value === 0 ? null : value)}
        clear={() => sample(null)}
      />
    </Stack>
  );
}
