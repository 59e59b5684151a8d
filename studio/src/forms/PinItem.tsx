// The entry of a menu that pins a number to the sliders, or unpins it.

import { Menu } from "@mantine/core";
import { IconPin, IconPinnedOff } from "@tabler/icons-react";

import { isAt, usePins, withoutPin } from "../state/pin";
import { keepPins, pin } from "../actions/pinning";

// `element` is empty for a document parameter.
export function PinItem({ element, path }: { element: string; path: string }) {
  const isPinned = usePins().some((at) => isAt(at, element, path));
  const Icon = isPinned ? IconPinnedOff : IconPin;
  return (
    <Menu.Item
      leftSection={<Icon size={14} />}
      onClick={() => (isPinned ? keepPins((pins) => withoutPin(pins, element, path)) : pin(element, path))}
    >
      {isPinned ? "Unpin from Sliders" : "Pin to Sliders"}
    </Menu.Item>
  );
}
