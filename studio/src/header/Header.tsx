// The bar above an open document: files, history, views, problems, help.

import { IconHelp, IconSearch } from "@tabler/icons-react";

import { openCommands } from "../commands/commands";
import { keysText } from "../model/keys";
import { SHORTCUTS } from "../commands/shortcuts";
import { IconButton } from "../widgets/Buttons";
import { DocumentName } from "./DocumentName";
import { FileMenu } from "./FileMenu";
import { NeedsServer } from "../widgets/NeedsServer";
import { ProblemsMenu } from "./ProblemsMenu";
import { ReportButton } from "../report/ReportButton";
import { SchemeToggle } from "../widgets/SchemeToggle";
import { UndoButtons } from "../widgets/UndoButtons";
import { Views } from "./Views";
import { ask } from "../state/questions";
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
