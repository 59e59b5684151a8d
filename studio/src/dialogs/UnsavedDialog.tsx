// Asks about unsaved edits before another document is opened.

import { Button, Group, Text } from "@mantine/core";

import type { Asking } from "./questions";

export function UnsavedDialog({ question, answer }: Asking<"unsaved">) {
  return (
    <>
      <Text size="sm" style={{ overflowWrap: "anywhere" }}>
        <b>{question.title === "" ? "The document" : question.title}</b> was edited since it was saved.
      </Text>
      <Group gap="xs" mt="lg" justify="flex-end">
        <Button variant="subtle" color="gray" onClick={() => answer("cancel")}>
          Cancel
        </Button>
        <Button variant="default" onClick={() => answer("discard")}>
          Discard edits
        </Button>
        <Button onClick={() => answer("save")} data-autofocus autoFocus>
          Save
        </Button>
      </Group>
    </>
  );
}
