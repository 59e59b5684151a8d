// Light or dark. Until it is pressed the page follows the system.

import { useComputedColorScheme, useMantineColorScheme } from "@mantine/core";
import { IconMoon, IconSun } from "@tabler/icons-react";

import { IconButton } from "./Buttons";

export function SchemeToggle() {
  const { setColorScheme } = useMantineColorScheme();
  const light = useComputedColorScheme("light") === "light";
  return (
    <IconButton
      icon={light ? IconMoon : IconSun}
      label={light ? "Dark colours" : "Light colours"}
      onClick={() => setColorScheme(light ? "dark" : "light")}
    />
  );
}
