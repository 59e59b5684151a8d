// The mark of deodar and, behind it, everything about files.

import { Menu } from "@mantine/core";
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

import { useStudio } from "../server/store";
import { Logo } from "../widgets/Logo";
import { exportScript, leave, open, openEmpty, save, saveAs } from "../files/flows";
import { takeValues } from "../files/presets";
import { openTool } from "../state/tool";
import { usePage } from "../state/page";
import { MenuEntry } from "../widgets/Buttons";
import { MenuList } from "../widgets/MenuList";
import classes from "./header.module.css";

export function FileMenu() {
  const recent = useStudio((state) => state.gallery?.recent) ?? [];
  const noted = useStudio((state) => (state.document?.notes ?? "") !== "");
  const imported = useStudio((state) => state.report !== null);
  return (
    <Menu position="bottom-start" width={260}>
      <Menu.Target>
        <button type="button" className={classes.mark} aria-label="File menu">
          <Logo size={26} />
          <IconChevronDown size={13} aria-hidden="true" />
        </button>
      </Menu.Target>
      <MenuList>
        <MenuEntry label="New" icon={IconFilePlus} onClick={() => void openEmpty()} />
        <MenuEntry label="Open…" icon={IconFolderOpen} keys="Ctrl+O" onClick={() => void open()} />
        <Menu.Sub>
          <Menu.Sub.Target>
            <Menu.Sub.Item
              leftSection={<IconHistory size={16} stroke={1.6} />}
              disabled={recent.length === 0}
            >
              Open recent
            </Menu.Sub.Item>
          </Menu.Sub.Target>
          <Menu.Sub.Dropdown>
            {recent.map((path) => (
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
        <MenuEntry
          label="Examples"
          icon={IconLayoutGrid}
          onClick={() => usePage.setState({ gallery: true })}
        />
        <Menu.Divider />
        <MenuEntry label="Save" icon={IconDeviceFloppy} keys="Ctrl+S" onClick={() => void save()} />
        <MenuEntry label="Save as…" icon={IconFileExport} keys="Ctrl+Shift+S" onClick={() => void saveAs()} />
        <MenuEntry
          label="Export as Python script"
          icon={IconBrandPython}
          onClick={() => void exportScript()}
        />
        <Menu.Divider />
        <MenuEntry label="Take over values…" icon={IconFileImport} onClick={() => void takeValues()} />
        <MenuEntry label="Notes" icon={IconNotes} disabled={!noted} onClick={() => openTool("notes")} />
        <MenuEntry
          label="Import report"
          icon={IconReport}
          disabled={!imported}
          onClick={() => openTool("report")}
        />
        <Menu.Divider />
        <MenuEntry label="Close" icon={IconX} onClick={() => void leave({ type: "close" })} />
      </MenuList>
    </Menu>
  );
}
