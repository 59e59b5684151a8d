// The world that the sensors read and the motors move, and a way to choose another one.

import { Button, Tooltip } from "@mantine/core";
import { IconWorld } from "@tabler/icons-react";

import { ask } from "../state/questions";
import { useStudio } from "../server/store";
import classes from "./Transport.module.css";

export function WorldButton() {
  const senses = useStudio((state) => state.clock?.senses ?? false);
  const world = useStudio((state) => state.clock?.world ?? "");
  if (!senses) {
    return null;
  }
  const blind = world === "";
  const reads = blind
    ? "The sensors read nothing yet. Choose a world, or drop a picture on the page."
    : `The world is ${world}. Choose another.`;
  return (
    <Tooltip label={reads}>
      <Button
        variant={blind ? "light" : "default"}
        size="compact-sm"
        className={classes.world}
        maw={{ base: 110, lg: 170 }}
        px={6}
        fw={500}
        leftSection={<IconWorld size={15} />}
        aria-label={blind ? "Choose a world" : `World: ${world}; choose another one`}
        onClick={() => void ask("world", null)}
      >
        <span className="one-line">{blind ? "World…" : world}</span>
      </Button>
    </Tooltip>
  );
}
