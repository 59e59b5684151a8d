// The bar above an open document: files, history, views, problems, help.

import { IconHelp, IconSearch } from "@tabler/icons-react";

import { openCommands } from "../build/commands";
import { keysText } from "../keys";
import { SHORTCUTS } from "../shortcuts";
import { IconButton } from "../widgets/Buttons";
import { DocumentName } from "./DocumentName";
import { FileMenu } from "./FileMenu";
import { NeedsServer } from "../connection/NeedsServer";
import { ProblemsMenu } from "./ProblemsMenu";
import { ReportButton } from "../report/ReportButton";
import { SchemeToggle } from "./SchemeToggle";
import { UndoButtons } from "./UndoButtons";
import { Views } from "./Views";
import { ask } from "../dialogs/questions";
import classes from "./header.module.css";

export function Header() {
  return (
    <header className={classes.header}>
      <div className={classes.side}>
        <NeedsServer>
          <FileMenu />
          <DocumentName />
          <UndoButtons />
        </NeedsServer>
      </div>
      <Views />
      <div className={classes.side}>
        <ReportButton />
        <ProblemsMenu />
        <IconButton
          icon={IconSearch}
          label="Find"
          tip={`Find a command or an element (${keysText("Ctrl+K")})`}
          onClick={() => openCommands(SHORTCUTS)}
        />
        <SchemeToggle />
        <IconButton
          icon={IconHelp}
          label="Help and keys"
          tip="Help and keys (?)"
          onClick={() => void ask("shortcuts", null)}
        />
      </div>
    </header>
  );
}
