// A file that could not be opened, with everything that is wrong in it.

import { Button, Group } from "@mantine/core";
import { IconArrowLeft, IconFileAlert, IconRefresh } from "@tabler/icons-react";
import { useState } from "react";

import type { FileProblems, ListedProblem } from "../protocol";
import { useStudio } from "../server/store";
import { ProblemText } from "../widgets/ProblemText";
import { leave } from "../files/flows";
import { belowRoot, isWhole } from "../model/paths";
import classes from "../widgets/problems.module.css";

export function ProblemsPage({ fileProblems: { file, problems } }: { fileProblems: FileProblems }) {
  const root = useStudio((state) => state.welcome?.root ?? "");
  const [trying, setTrying] = useState(false);
  const again = async () => {
    setTrying(true);
    await leave({ type: "open_file", path: file });
    setTrying(false);
  };
  const count = problems.length;
  return (
    <main className={classes.page}>
      <div className={`down wrapped ${classes.column}`}>
        <header className="across">
          <IconFileAlert size={34} stroke={1.5} color="var(--error)" aria-hidden="true" />
          <div className="grow">
            <h1>{belowRoot(root, file)} cannot be opened</h1>
            <span className="dim">
              {count === 1 ? "There is one problem." : `There are ${count} problems.`}
            </span>
          </div>
        </header>
        <ol className="card" aria-label="Problems">
          {problems.map((problem, i) => (
            <li key={i}>
              <span className="dim" aria-hidden="true">
                {i + 1}
              </span>
              <ProblemText problem={within(file, problem)} />
            </li>
          ))}
        </ol>
        <Group gap="xs">
          {isWhole(file) && (
            <Button
              leftSection={<IconRefresh size={16} />}
              loading={trying}
              onClick={() => void again()}
              autoFocus
            >
              Try again
            </Button>
          )}
          <Button
            variant="default"
            leftSection={<IconArrowLeft size={16} />}
            onClick={() => void leave({ type: "close" })}
          >
            Back to the gallery
          </Button>
        </Group>
      </div>
    </main>
  );
}

// The file is named above; where in it is what matters here.
function within(file: string, problem: ListedProblem): ListedProblem {
  const where = problem.where ?? "";
  return {
    ...problem,
    where: where === file ? "" : where.startsWith(`${file}: `) ? where.slice(file.length + 2) : where,
  };
}
