// What can be done with a parameter beside changing it: back to the default, pin, link.

import { Menu } from "@mantine/core";
import { IconArrowBackUp, IconLink, IconLinkOff, IconPlus } from "@tabler/icons-react";
import type { ReactNode } from "react";

import type { DocumentParameterView } from "../protocol";
import { request } from "../server/socket";
import { useStudio } from "../server/store";
import { DotsMenu } from "../widgets/DotsMenu";
import { PinItem } from "./PinItem";

type RowMenuProps = {
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
  const { element, path, driver, byDefault, atDefault, onReset, pinnable, linkable, onName } = props;
  const documentParameters = useStudio((state) => state.document?.parameters) ?? [];
  const link = (name: string) => void request({ type: "link", name, element, parameter: path });
  const unlink = () => void request({ type: "unlink", element, parameter: path });
  return (
    <DotsMenu label={`More for ${path}`} opened={props.opened} onOpened={props.onOpened}>
      {onReset !== undefined && (
        <Menu.Item
          leftSection={<IconArrowBackUp size={14} />}
          rightSection={<span className="dim one-line menu-value">{byDefault}</span>}
          disabled={atDefault || driver !== undefined}
          onClick={onReset}
        >
          Reset to default
        </Menu.Item>
      )}
      {pinnable && <PinItem element={element} path={path} />}
      {linkable && driver !== undefined && (
        <Menu.Item leftSection={<IconLinkOff size={14} />} onClick={unlink}>
          Unlink from {driver.name}
        </Menu.Item>
      )}
      {linkable && driver === undefined && (
        <>
          <Menu.Label>Link to</Menu.Label>
          {documentParameters.map(({ name }) => (
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
    </DotsMenu>
  );
}
