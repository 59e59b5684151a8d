// A file is in the way, or it was changed by something else since it was read.

import { Button, Group, Text } from "@mantine/core";

import type { Asking } from "./questions";

export function ReplaceDialog({ question, answer }: Asking<"replace">) {
  return (
    <>
      <Text size="sm" style={{ overflowWrap: "anywhere" }}>
        <b>{question.path}</b>{" "}
        {question.own ? "was changed on disk since it was opened or saved here." : "is there already."}
      </Text>
      <Group gap="xs" mt="lg" justify="flex-end">
        <Button variant="subtle" color="gray" onClick={() => answer("cancel")}>
          Cancel
        </Button>
        <Button variant="default" color="red" onClick={() => answer("replace")}>
          Write over it
        </Button>
        <Button onClick={() => answer("elsewhere")} data-autofocus autoFocus>
          Save as…
        </Button>
      </Group>
    </>
  );
}
