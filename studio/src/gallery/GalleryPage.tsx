// The first page: a file, a recent document, or an example.

import { Button, Group } from "@mantine/core";
import { IconArrowLeft, IconFile, IconFilePlus, IconFolderOpen, IconWalk } from "@tabler/icons-react";

import { useStudio } from "../store";
import { startTour } from "../tour/tour";
import { ExampleCard } from "./ExampleCard";
import { Logo } from "./Logo";
import { RecoveryCard } from "./RecoveryCard";
import { SchemeToggle } from "../header/SchemeToggle";
import { leave, open, openEmpty } from "../files/flows";
import { lastPart, parent } from "../files/paths";
import { useView } from "./view";
import classes from "./GalleryPage.module.css";

export function GalleryPage() {
  const title = useStudio((state) => state.document?.title ?? null);
  const welcome = useStudio((state) => state.welcome);
  const gallery = useStudio((state) => state.gallery);
  const recent = gallery?.recent ?? [];
  const recoveries = gallery?.recoveries ?? [];
  return (
    <main className={classes.page}>
      <div className={classes.column}>
        <header className={classes.header}>
          <Logo size={40} />
          <div className={classes.titles}>
            <h1>deodar studio</h1>
            <p>Open an architecture of neural fields, run it, and watch its response.</p>
          </div>
          {title !== null && (
            <Button
              variant="default"
              maw={260}
              leftSection={<IconArrowLeft size={16} />}
              onClick={() => useView.setState({ gallery: false })}
            >
              Back to {title}
            </Button>
          )}
          <SchemeToggle />
        </header>

        {recoveries.map((recovery) => (
          <RecoveryCard key={recovery.name} recovery={recovery} />
        ))}

        <section className={classes.files} aria-label="Files">
          <Group gap="sm" className={classes.open}>
            <Button leftSection={<IconFolderOpen size={17} />} onClick={() => void open()}>
              Open a file
            </Button>
            <Button
              variant="default"
              leftSection={<IconFilePlus size={17} />}
              onClick={() => void openEmpty()}
            >
              Empty document
            </Button>
            <span className={classes.hint}>or drop a file on this page</span>
            <Button
              variant="default"
              ml="auto"
              leftSection={<IconWalk size={17} />}
              onClick={() => void startTour()}
            >
              Tour of five minutes
            </Button>
          </Group>
          {recent.length > 0 && (
            <ul className={classes.recent} aria-label="Recent files">
              {recent.map((path) => (
                <li key={path}>
                  <button
                    type="button"
                    className={classes.file}
                    title={path}
                    onClick={() => void leave({ type: "open_file", path })}
                  >
                    <IconFile size={16} stroke={1.5} aria-hidden="true" />
                    <span className="one-line">{lastPart(path)}</span>
                    <span className={`${classes.folder} one-line`}>{parent(path)}</span>
                  </button>
                </li>
              ))}
            </ul>
          )}
        </section>

        <section aria-labelledby="examples">
          <h2 id="examples" className={classes.heading}>
            Examples
          </h2>
          <ul className={classes.grid}>
            {welcome?.examples.map((example) => (
              <li key={example.name}>
                <ExampleCard example={example} />
              </li>
            ))}
          </ul>
        </section>

        <footer className={classes.footer}>
          deodar {welcome?.version}{" "}
          <span title="Files are read and written below this folder">{welcome?.root}</span>
        </footer>
      </div>
    </main>
  );
}
