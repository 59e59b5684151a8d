// Snapshots of the run to return to, and presets: values of all parameters. Both are files below the root.

import {
  ActionIcon,
  Button,
  CloseButton,
  Group,
  Popover,
  Stack,
  TextInput,
  Tooltip,
  VisuallyHidden,
} from "@mantine/core";
import { IconBookmark } from "@tabler/icons-react";
import { type FormEvent, useState } from "react";

import { applyPreset } from "../files/presets";
import { KeptPresets } from "../pins/KeptPresets";
import { whenText } from "../files/when";
import { request } from "../socket";
import { useStudio } from "../store";
import { timeText } from "../transport/format";
import { stop } from "./replay";
import classes from "./SavedMenu.module.css";

export function SavedMenu() {
  const [opened, setOpened] = useState(false);
  const toggle = () => {
    setOpened(!opened);
    if (!opened) {
      void request({ type: "list_saved" });
    }
  };
  return (
    <Popover
      opened={opened}
      onChange={setOpened}
      position="bottom-end"
      withArrow
      shadow="md"
      trapFocus
      returnFocus
    >
      <Popover.Target>
        <Tooltip label="Snapshots and presets" disabled={opened}>
          <ActionIcon size={24} aria-label="Snapshots and presets" onClick={toggle}>
            <IconBookmark size={16} />
          </ActionIcon>
        </Tooltip>
      </Popover.Target>
      <Popover.Dropdown p="md" w={360} maw="100vw">
        <Stack gap="md">
          <Snapshots />
          <Presets />
        </Stack>
      </Popover.Dropdown>
    </Popover>
  );
}

function Snapshots() {
  const kept = useStudio((state) => state.savedFiles?.snapshots);
  const unit = useStudio((state) => state.document?.time_unit ?? "");
  const dt = useStudio((state) => state.clock?.dt ?? 1);
  const now = useStudio((state) => state.clock?.time ?? 0);
  const back = (name: string) => {
    stop();
    void request({ type: "return_to", name });
  };
  return (
    <section aria-label="Snapshots">
      <h3 className={classes.title}>Snapshots</h3>
      <p className={classes.hint}>The whole state of the run, with its parameters.</p>
      <Naming
        label="Name of the snapshot"
        suggested={`at ${timeText(now, unit, dt)}`}
        save="Save snapshot"
        send={(name) => request({ type: "save_snapshot", name })}
      />
      {kept?.map(({ name, time, saved, size }) => (
        <Row
          key={name}
          sort="snapshot"
          name={name}
          about={`${timeText(time, unit, dt)}, ${sizeText(size)}, saved ${whenText(saved, new Date())}`}
          does="Return to"
          run={() => back(name)}
        />
      ))}
    </section>
  );
}

function Presets() {
  const kept = useStudio((state) => state.savedFiles?.presets);
  return (
    <section aria-label="Presets">
      <h3 className={classes.title}>Presets</h3>
      <p className={classes.hint}>The values of all parameters; the state of the run stays.</p>
      <Naming
        label="Name of the preset"
        suggested=""
        save="Save preset"
        send={(name) => request({ type: "save_preset", name })}
      />
      <KeptPresets />
      {kept?.map(({ name, path, saved, size }) => (
        <Row
          key={name}
          sort="preset"
          name={name}
          about={`${sizeText(size)}, saved ${whenText(saved, new Date())}`}
          does="Apply"
          run={() => void applyPreset(path)}
        />
      ))}
    </section>
  );
}

type Send = (name: string) => ReturnType<typeof request>;
type NamingProps = { label: string; suggested: string; save: string; send: Send };

function Naming({ label, suggested, save, send }: NamingProps) {
  const [name, setName] = useState("");
  const submit = async (event: FormEvent) => {
    event.preventDefault();
    const wanted = name.trim() || suggested;
    if (wanted !== "" && ((await send(wanted)).problems ?? []).length === 0) {
      setName("");
    }
  };
  return (
    <form onSubmit={(event) => void submit(event)}>
      <Group gap={6} wrap="nowrap" mb={6}>
        <TextInput
          size="xs"
          flex={1}
          aria-label={label}
          placeholder={suggested || "Name"}
          value={name}
          maxLength={80}
          spellCheck={false}
          onChange={(event) => setName(event.currentTarget.value)}
        />
        <Button size="xs" type="submit" variant="default" disabled={(name.trim() || suggested) === ""}>
          {save}
        </Button>
      </Group>
    </form>
  );
}

type KeptProps = {
  sort: "snapshot" | "preset";
  name: string;
  about: string;
  does: string;
  run: () => void;
};

function Row({ sort, name, about, does, run }: KeptProps) {
  return (
    <div className={classes.row}>
      <button type="button" className={classes.choice} title={`${does} ${name}`} onClick={run}>
        <span className="one-line">
          <VisuallyHidden>{does} </VisuallyHidden>
          {name}
        </span>
        <span className={`${classes.about} numbers one-line`}>{about}</span>
      </button>
      <CloseButton
        size="sm"
        aria-label={`Delete the ${sort} ${name}`}
        title={`Delete the ${sort} ${name}`}
        onClick={(event) => {
          // this button disappears: without a focus inside, Escape would not close the menu
          event.currentTarget.closest("section")?.querySelector("input")?.focus();
          void request({ type: "remove_saved", sort, name });
        }}
      />
    </div>
  );
}

function sizeText(bytes: number): string {
  return bytes < 1e6 ? `${Math.max(1, Math.round(bytes / 1e3))} kB` : `${(bytes / 1e6).toPrecision(3)} MB`;
}
