// The bar above an open document: files, history, views, problems, help.

import { ActionIcon, Tooltip } from "@mantine/core";
import { IconHelp, IconSearch } from "@tabler/icons-react";

import { openCommands } from "../build/commands";
import { keysText } from "../keys";
import { SHORTCUTS } from "../shortcuts";
import { DocumentName } from "./DocumentName";
import { FileMenu } from "./FileMenu";
import { NeedsServer } from "../connection/NeedsServer";
import { ProblemsMenu } from "./ProblemsMenu";
import { ReportButton } from "../report/ReportButton";
import { SchemeToggle } from "./SchemeToggle";
import { UndoButtons } from "./UndoButtons";
import { Views } from "./Views";
import { ask } from "../dialogs/questions";
import classes from "./Header.module.css";

export function Header() {
  return (
    <header className={classes.header}>
      <div className={classes.left}>
        <NeedsServer>
          <FileMenu />
          <DocumentName />
          <UndoButtons />
        </NeedsServer>
      </div>
      <Views />
      <div className={classes.right}>
        <ReportButton />
        <ProblemsMenu />
        <Tooltip label={`Find a command or an element (${keysText("Ctrl+K")})`}>
          <ActionIcon aria-label="Find" size={28} onClick={() => openCommands(SHORTCUTS)}>
            <IconSearch size={17} />
          </ActionIcon>
        </Tooltip>
        <SchemeToggle />
        <Tooltip label="Help and keys (?)">
          <ActionIcon aria-label="Help and keys" size={28} onClick={() => void ask("shortcuts", null)}>
            <IconHelp size={18} />
          </ActionIcon>
        </Tooltip>
      </div>
    </header>
  );
}
