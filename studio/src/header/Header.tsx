// The bar above an open document: files, history, the run, panels.

import { ActionIcon, Tooltip } from "@mantine/core";
import { IconHelp } from "@tabler/icons-react";

import { PanelMenu } from "../panels/PanelMenu";
import { Transport } from "../transport/Transport";
import { DocumentName } from "./DocumentName";
import { FileMenu } from "./FileMenu";
import { NeedsServer } from "../connection/NeedsServer";
import { ProblemsMenu } from "./ProblemsMenu";
import { ReportButton } from "../report/ReportButton";
import { SchemeToggle } from "./SchemeToggle";
import { UndoButtons } from "./UndoButtons";
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
      <NeedsServer>
        <Transport />
      </NeedsServer>
      <div className={classes.right}>
        <ReportButton />
        <ProblemsMenu />
        <PanelMenu />
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
