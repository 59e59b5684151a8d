// Snapshots of the run to return to, and presets: values of all parameters. Both are files below the root.

import {
  ActionIcon,
  Button,
  CloseButton,
  Group,
  Stack,
  TextInput,
  UnstyledButton,
  VisuallyHidden,
} from "@mantine/core";
import { IconBookmark } from "@tabler/icons-react";
import { type FormEvent, type ReactNode, useState } from "react";

import { applyPreset } from "../files/presets";
import { KeptPresets } from "../pins/KeptPresets";
import { whenText } from "../model/when";
import { request } from "../server/socket";
import { useStudio } from "../server/store";
import { timeText } from "../model/format";
import { ButtonPopover } from "../widgets/ButtonPopover";
import { stop } from "../actions/replay";
import classes from "./SavedMenu.module.css";

export function SavedMenu() {
  return (
    <ButtonPopover
      tip="Snapshots and presets"
      width={360}
      position="bottom-end"
      button={(toggle) => (
        <ActionIcon size={24} aria-label="Snapshots and presets" onClick={toggle}>
          <IconBookmark size={16} />
        </ActionIcon>
      )}
      onOpen={() => void request({ type: "list_saved" })}
    >
      <Stack gap="md">
        <Snapshots />
        <Presets />
      </Stack>
    </ButtonPopover>
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
    <Section
      sort="snapshot"
      title="Snapshots"
      hint="The whole state of the run, with its parameters."
      suggested={`at ${timeText(now, unit, dt)}`}
    >
      {kept?.map(({ name, time, ...file }) => (
        <Row
          key={name}
          sort="snapshot"
          name={name}
          about={`${timeText(time, unit, dt)}, ${aboutFile(file)}`}
          does="Return to"
          run={() => back(name)}
        />
      ))}
    </Section>
  );
}

function Presets() {
  const kept = useStudio((state) => state.savedFiles?.presets);
  return (
    <Section
      sort="preset"
      title="Presets"
      hint="The values of all parameters; the state of the run stays."
      suggested=""
    >
      <KeptPresets />
      {kept?.map(({ name, path, ...file }) => (
        <Row
          key={name}
          sort="preset"
          name={name}
          about={aboutFile(file)}
          does="Apply"
          run={() => void applyPreset(path)}
        />
      ))}
    </Section>
  );
}

type Sort = "snapshot" | "preset";
type SectionProps = { sort: Sort; title: string; hint: string; suggested: string; children: ReactNode };

// With a name for the next one above the list.
function Section({ sort, title, hint, suggested, children }: SectionProps) {
  const [typed, setTyped] = useState("");
  const name = typed.trim() || suggested;
  const submit = async (event: FormEvent) => {
    event.preventDefault();
    if (name !== "" && ((await request({ type: `save_${sort}`, name })).problems ?? []).length === 0) {
      setTyped("");
    }
  };
  return (
    <section aria-label={title}>
      <h3 className={classes.title}>{title}</h3>
      <p className={`${classes.hint} dim`}>{hint}</p>
      <form onSubmit={(event) => void submit(event)}>
        <Group gap={6} wrap="nowrap" mb={6}>
          <TextInput
            flex={1}
            aria-label={`Name of the ${sort}`}
            placeholder={suggested || "Name"}
            value={typed}
            maxLength={80}
            onChange={(event) => setTyped(event.currentTarget.value)}
          />
          <Button size="xs" type="submit" variant="default" disabled={name === ""}>
            Save {sort}
          </Button>
        </Group>
      </form>
      {children}
    </section>
  );
}

type SavedProps = { sort: Sort; name: string; about: string; does: string; run: () => void };

function Row({ sort, name, about, does, run }: SavedProps) {
  return (
    <div className={`flow ${classes.row}`}>
      <UnstyledButton className={classes.choice} title={`${does} ${name}`} onClick={run}>
        <span className="one-line">
          <VisuallyHidden>{does} </VisuallyHidden>
          {name}
        </span>
        <span className={"fine numbers one-line"}>{about}</span>
      </UnstyledButton>
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

function aboutFile({ size, saved }: { size: number; saved: string }): string {
  const space =
    size < 1e6 ? `${Math.max(1, Math.round(size / 1e3))} kB` : `${(size / 1e6).toPrecision(3)} MB`;
  return `${space}, saved ${whenText(saved, new Date())}`;
}
