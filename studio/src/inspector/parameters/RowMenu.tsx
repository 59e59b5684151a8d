// What can be done with a parameter beside changing it: back to the default, pin, link.

import { Menu } from "@mantine/core";
import {
  IconArrowBackUp,
  IconLink,
  IconLinkOff,
  IconPin,
  IconPinnedOff,
  IconPlus,
} from "@tabler/icons-react";
import type { ReactNode } from "react";

import { isAt, keepPins, pin, pinsOf, withoutPin } from "../../pins/pin";
import type { DocumentParameterView } from "../../protocol";
import { request } from "../../socket";
import { useStudio } from "../../store";
import { DotsMenu } from "../../widgets/DotsMenu";

export type RowMenuProps = {
  element: string;
  path: string;
  driver?: DocumentParameterView;
  // The default in words, and the way back to it; without them there is no default.
  byDefault?: ReactNode;
  atDefault: boolean;
  onReset?: () => void;
  pinnable: boolean;
  linkable: boolean;
  opened: boolean;
  onOpened: (opened: boolean) => void;
  onName: () => void;
};

export function RowMenu(props: RowMenuProps) {
  const { path, opened, onOpened } = props;
  return (
    <DotsMenu label={`More for ${path}`} opened={opened} onOpened={onOpened}>
      <RowMenuItems {...props} />
    </DotsMenu>
  );
}

function RowMenuItems({
  element,
  path,
  driver,
  byDefault,
  atDefault,
  onReset,
  pinnable,
  linkable,
  onName,
}: RowMenuProps) {
  const pinned = useStudio((state) => pinsOf(state.document?.layout).some((pin) => isAt(pin, element, path)));
  const documentParameters = useStudio((state) => state.document?.parameters);
  const link = (name: string) => void request({ type: "link", name, element, parameter: path });
  const unlink = () => void request({ type: "unlink", element, parameter: path });
  return (
    <>
      {onReset !== undefined && (
        <Menu.Item
          leftSection={<IconArrowBackUp size={14} />}
          rightSection={<span className="dim menu-value">{byDefault}</span>}
          disabled={atDefault || driver !== undefined}
          onClick={onReset}
        >
          Reset to default
        </Menu.Item>
      )}
      {pinnable &&
        (pinned ? (
          <Menu.Item
            leftSection={<IconPinnedOff size={14} />}
            onClick={() => keepPins((pins) => withoutPin(pins, element, path))}
          >
            Unpin from Sliders
          </Menu.Item>
        ) : (
          <Menu.Item leftSection={<IconPin size={14} />} onClick={() => pin(element, path)}>
            Pin to Sliders
          </Menu.Item>
        ))}
      {linkable && driver !== undefined && (
        <Menu.Item leftSection={<IconLinkOff size={14} />} onClick={unlink}>
          Unlink from {driver.name}
        </Menu.Item>
      )}
      {linkable && driver === undefined && (
        <>
          <Menu.Label>Link to</Menu.Label>
          {(documentParameters ?? []).map(({ name }) => (
            <Menu.Item key={name} leftSection={<IconLink size={14} />} onClick={() => link(name)}>
              <span className="one-line" title={name}>
                {name}
              </span>
            </Menu.Item>
          ))}
          <Menu.Item leftSection={<IconPlus size={14} />} onClick={onName}>
            New document parameter…
          </Menu.Item>
        </>
      )}
    </>
  );
}
