// The values of a file that did not match when they were applied.

import { Button, Group, Text } from "@mantine/core";

import type { Asking } from "./questions";
import { takenText } from "../files/presets";
import classes from "./TakenDialog.module.css";

export function TakenDialog({ question: { file, carried, unmatched }, answer }: Asking<"taken">) {
  const label =
    unmatched.length === 1 ? "1 entry did not match" : `${unmatched.length} entries did not match`;
  return (
    <>
      <Text size="sm" style={{ overflowWrap: "anywhere" }}>
        {takenText(carried, file)} {label} and left the values here unchanged:
      </Text>
      <ul className={classes.list} aria-label={label} tabIndex={0}>
        {unmatched.map((line, i) => (
          <li key={i}>{line}</li>
        ))}
      </ul>
      <Group gap="xs" mt="lg" justify="flex-end">
        {carried > 0 && (
          <Button variant="default" onClick={() => answer("undo")}>
            Undo
          </Button>
        )}
        <Button onClick={() => answer("keep")} data-autofocus autoFocus>
          {carried > 0 ? "Keep" : "Close"}
        </Button>
      </Group>
    </>
  );
}
