// The whole page, and the windows in front of it.

import { useEffect } from "react";

import { Chooser } from "./palette/Chooser";
import { Workspace } from "./frame/Workspace";
import { Dialogs } from "./dialogs/Dialogs";
import { DropArea } from "./files/DropArea";
import { GalleryPage } from "./gallery/GalleryPage";
import { Header } from "./header/Header";
import { NeedsServer } from "./widgets/NeedsServer";
import { Notices } from "./problems/Notices";
import { ProblemsPage } from "./problems/ProblemsPage";
import { RecoveryBar } from "./gallery/RecoveryCard";
import { LostBanner, Splash } from "./connection/Splash";
import { usePage } from "./state/page";
import { ComparisonBar } from "./replay/ComparisonBar";
import { RecordNotes } from "./replay/RecordNotes";
import { useShortcuts } from "./commands/shortcuts";
import { useStudio } from "./server/store";
import { TourCard } from "./tour/TourCard";
import { FailureBar } from "./transport/FailureBar";
import { Foot } from "./transport/Foot";
import { useRobotStop } from "./world/LinkState";
import classes from "./App.module.css";

export function App() {
  useRobotStop();
  useShortcuts();
  useAskBeforeLeaving();
  return (
    <div className={classes.app}>
      <LostBanner />
      <div className={classes.page}>
        <Page />
      </div>
      <Notices />
      <Dialogs />
      <DropArea />
      <TourCard />
    </div>
  );
}

function Page() {
  const ready = useStudio((state) => state.welcome !== null);
  const fileProblems = useStudio((state) => state.fileProblems);
  const open = useStudio((state) => state.document !== null);
  const gallery = usePage((page) => page.gallery);
  if (!ready) {
    return <Splash />;
  }
  if (fileProblems !== null) {
    return (
      <NeedsServer>
        <ProblemsPage fileProblems={fileProblems} />
      </NeedsServer>
    );
  }
  if (!open || gallery) {
    return (
      <NeedsServer>
        <GalleryPage />
      </NeedsServer>
    );
  }
  return (
    <div className={classes.studio}>
      <Header />
      <NeedsServer>
        <RecoveryBar />
        <RecordNotes />
        <ComparisonBar />
        <FailureBar />
      </NeedsServer>
      <div className={classes.body}>
        <Workspace />
      </div>
      <Foot />
      <Chooser />
    </div>
  );
}

// The browser asks before a page with unsaved edits is closed.
function useAskBeforeLeaving(): void {
  const unsaved = useStudio((state) => state.document?.unsaved || state.experiment?.unsaved || false);
  useEffect(() => {
    if (!unsaved) {
      return;
    }
    const leaving = (event: BeforeUnloadEvent) => event.preventDefault();
    addEventListener("beforeunload", leaving);
    return () => removeEventListener("beforeunload", leaving);
  }, [unsaved]);
}
