// What the sensors read, and a way to show them another picture. Only where something senses.

import { Button, Tooltip } from "@mantine/core";
import { IconPhoto } from "@tabler/icons-react";

import { choosePicture } from "../pages/flows";
import { useStudio } from "../store";
import classes from "./Transport.module.css";

export function WorldButton() {
  const senses = useStudio((state) => state.clock?.senses ?? false);
  const world = useStudio((state) => state.clock?.world ?? "");
  if (!senses) {
    return null;
  }
  const blind = world === "";
  const reads = blind
    ? "The sensors read nothing yet. Choose a picture, or drop one on the page."
    : `The sensors read ${world}. Choose another.`;
  return (
    <Tooltip label={reads}>
      <Button
        variant={blind ? "light" : "default"}
        size="compact-sm"
        className={classes.world}
        maw={{ base: 110, lg: 170 }}
        px={6}
        fw={500}
        leftSection={<IconPhoto size={15} />}
        aria-label={blind ? "Choose a picture" : `The sensors read ${world}; choose another picture`}
        onClick={() => void choosePicture()}
      >
        <span className="one-line">{blind ? "Picture…" : world}</span>
      </Button>
    </Tooltip>
  );
}
