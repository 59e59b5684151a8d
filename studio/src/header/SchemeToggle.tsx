// Light or dark. Until it is pressed the page follows the system.

import { ActionIcon, Tooltip, useComputedColorScheme, useMantineColorScheme } from "@mantine/core";
import { IconMoon, IconSun } from "@tabler/icons-react";

export function SchemeToggle() {
  const scheme = useComputedColorScheme("light");
  const { setColorScheme } = useMantineColorScheme();
  const other = scheme === "dark" ? "light" : "dark";
  return (
    <Tooltip label={other === "dark" ? "Dark colours" : "Light colours"}>
      <ActionIcon
        size={28}
        aria-label={other === "dark" ? "Dark colours" : "Light colours"}
        onClick={() => setColorScheme(other)}
      >
        {other === "dark" ? <IconMoon size={17} /> : <IconSun size={17} />}
      </ActionIcon>
    </Tooltip>
  );
}
