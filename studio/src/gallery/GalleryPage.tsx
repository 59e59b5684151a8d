// The first page: a file, a recent document, or an example.

import { Button, Group } from "@mantine/core";
import { IconArrowLeft, IconFile, IconFilePlus, IconFolderOpen, IconWalk } from "@tabler/icons-react";
import { useState } from "react";

import type { ExampleView } from "../protocol";
import { usePage } from "../state/page";
import { useStudio } from "../server/store";
import { startTour } from "../tour/tour";
import { Logo } from "../widgets/Logo";
import { RecoveryCard } from "./RecoveryCard";
import { SchemeToggle } from "../widgets/SchemeToggle";
import { leave, open, openEmpty } from "../files/flows";
import { lastPart, parent } from "../model/paths";
import classes from "./gallery.module.css";

export function GalleryPage() {
  const title = useStudio((state) => state.document?.title ?? null);
  const welcome = useStudio((state) => state.welcome);
  const { recent = [], recoveries = [] } = useStudio((state) => state.gallery) ?? {};
  return (
    <main className={classes.page}>
      <div className="down">
        <header className="across">
          <Logo size={40} />
          <div className="grow">
            <h1>deodar studio</h1>
            <p className="dim">Open an architecture of neural fields, run it, and watch its response.</p>
          </div>
          {title !== null && (
            <Button
              variant="default"
              maw={260}
              leftSection={<IconArrowLeft size={16} />}
              onClick={() => usePage.setState({ gallery: false })}
            >
              Back to {title}
            </Button>
          )}
          <SchemeToggle />
        </header>

        {recoveries.map((recovery) => (
          <RecoveryCard key={recovery.name} recovery={recovery} />
        ))}

        <section aria-label="Files">
          <Group gap="sm">
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
            <span className="dim">or drop a file on this page</span>
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
                    className="list-entry"
                    title={path}
                    onClick={() => void leave({ type: "open_file", path })}
                  >
                    <IconFile size={16} stroke={1.5} aria-hidden="true" />
                    <span className="one-line">{lastPart(path)}</span>
                    <span className="one-line grow dim small">{parent(path)}</span>
                  </button>
                </li>
              ))}
            </ul>
          )}
        </section>

        <section aria-labelledby="examples">
          <h2 id="examples">Examples</h2>
          <ul className={classes.grid}>
            {welcome?.examples.map((example) => (
              <li key={example.name}>
                <ExampleCard example={example} />
              </li>
            ))}
          </ul>
        </section>

        <footer className="dim small wrapped">
          deodar {welcome?.version}{" "}
          <span title="Files are read and written below this folder">{welcome?.root}</span>
        </footer>
      </div>
    </main>
  );
}

// Its picture and its first sentence.
function ExampleCard({ example: { name, title, sentence, picture } }: { example: ExampleView }) {
  const [missing, setMissing] = useState(picture === "");
  return (
    <button
      type="button"
      className={`card ${classes.example}`}
      onClick={() => void leave({ type: "open_example", name })}
    >
      <span className={classes.picture}>
        {missing && <Logo size={40} color="var(--edge)" />}
        {!missing && <img src={picture} alt="" loading="lazy" onError={() => setMissing(true)} />}
      </span>
      <span className={`down ${classes.text}`}>
        <b>{title}</b>
        <span className="dim small">{sentence}</span>
      </span>
    </button>
  );
}
