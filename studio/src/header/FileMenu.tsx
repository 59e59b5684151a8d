// The mark of deodar and, behind it, everything about files.

import { Menu, UnstyledButton } from "@mantine/core";
import {
  IconBrandPython,
  IconChevronDown,
  IconDeviceFloppy,
  IconFileExport,
  IconFileImport,
  IconFilePlus,
  IconFolderOpen,
  IconHistory,
  IconLayoutGrid,
  IconNotes,
  IconReport,
  IconX,
} from "@tabler/icons-react";

import { useStudio } from "../store";
import { Logo } from "../gallery/Logo";
import { exportScript } from "../files/exportScript";
import { leave, open, openEmpty, save, saveAs } from "../files/flows";
import { takeValues } from "../files/presets";
import { useView } from "../gallery/view";
import { openTool } from "../state/tool";
import { keysText } from "../keys";
import { MenuList } from "../widgets/MenuList";
import classes from "./FileMenu.module.css";

const ICON = { size: 16, stroke: 1.6 };

export function FileMenu() {
  const recent = useStudio((state) => state.gallery?.recent);
  const noted = useStudio((state) => (state.document?.notes ?? "") !== "");
  const imported = useStudio((state) => state.report !== null);
  return (
    <Menu position="bottom-start" shadow="md" width={260} withinPortal>
      <Menu.Target>
        <UnstyledButton className={classes.target} aria-label="File menu">
          <Logo size={26} />
          <IconChevronDown size={13} aria-hidden="true" />
        </UnstyledButton>
      </Menu.Target>
      <MenuList>
        <Menu.Item leftSection={<IconFilePlus {...ICON} />} onClick={() => void openEmpty()}>
          New
        </Menu.Item>
        <Menu.Item
          leftSection={<IconFolderOpen {...ICON} />}
          rightSection={<Keys keys="Ctrl+O" />}
          onClick={() => void open()}
        >
          Open…
        </Menu.Item>
        <Menu.Sub>
          <Menu.Sub.Target>
            <Menu.Sub.Item
              leftSection={<IconHistory {...ICON} />}
              disabled={recent === undefined || recent.length === 0}
            >
              Open recent
            </Menu.Sub.Item>
          </Menu.Sub.Target>
          <Menu.Sub.Dropdown>
            {recent?.map((path) => (
              <Menu.Item
                key={path}
                maw={360}
                title={path}
                onClick={() => void leave({ type: "open_file", path })}
              >
                {path}
              </Menu.Item>
            ))}
          </Menu.Sub.Dropdown>
        </Menu.Sub>
        <Menu.Item
          leftSection={<IconLayoutGrid {...ICON} />}
          onClick={() => useView.setState({ gallery: true })}
        >
          Examples
        </Menu.Item>
        <Menu.Divider />
        <Menu.Item
          leftSection={<IconDeviceFloppy {...ICON} />}
          rightSection={<Keys keys="Ctrl+S" />}
          onClick={() => void save()}
        >
          Save
        </Menu.Item>
        <Menu.Item
          leftSection={<IconFileExport {...ICON} />}
          rightSection={<Keys keys="Ctrl+Shift+S" />}
          onClick={() => void saveAs()}
        >
          Save as…
        </Menu.Item>
        <Menu.Item leftSection={<IconBrandPython {...ICON} />} onClick={() => void exportScript()}>
          Export as Python script
        </Menu.Item>
        <Menu.Divider />
        <Menu.Item leftSection={<IconFileImport {...ICON} />} onClick={() => void takeValues()}>
          Take over values…
        </Menu.Item>
        <Menu.Item leftSection={<IconNotes {...ICON} />} disabled={!noted} onClick={() => openTool("notes")}>
          Notes
        </Menu.Item>
        <Menu.Item
          leftSection={<IconReport {...ICON} />}
          disabled={!imported}
          onClick={() => openTool("report")}
        >
          Import report
        </Menu.Item>
        <Menu.Divider />
        <Menu.Item leftSection={<IconX {...ICON} />} onClick={() => void leave({ type: "close" })}>
          Close
        </Menu.Item>
      </MenuList>
    </Menu>
  );
}

function Keys({ keys }: { keys: string }) {
  return <span className={classes.keys}>{keysText(keys)}</span>;
}
