// The card of the tour in a corner of the page, and the outline of what its step uses.

import { Button, CloseButton } from "@mantine/core";
import { IconCircleCheck } from "@tabler/icons-react";
import { useEffect } from "react";

import { useStudio } from "../server/store";
import { STEPS } from "./steps";
import { endTour, follow, goTo, useTour } from "./tour";
import { useOutline } from "./useOutline";
import classes from "./TourCard.module.css";

export function TourCard() {
  const step = useTour((tour) => tour.step);
  useEffect(() => useStudio.subscribe(follow), []);
  return step === null ? null : <Shown step={step} />;
}

function Shown({ step }: { step: number }) {
  const done = useTour((tour) => tour.done);
  const outline = useOutline(step);
  const { title, text, lesson } = STEPS[step] ?? { title: "", text: "", lesson: "" };
  return (
    <>
      {outline !== null && !done && (
        <div className={classes.outline} style={outline.style} aria-hidden="true" />
      )}
      <aside
        className={`card down ${classes.card}`}
        aria-label="Tour"
        data-left={outline?.right || undefined}
      >
        <header className="across">
          <span className="dim small">
            {step + 1} of {STEPS.length}
          </span>
          <h2 className="grow">{title}</h2>
          <CloseButton size="sm" aria-label="End the tour" onClick={endTour} />
        </header>
        <p>{text}</p>
        <p className={classes.lesson} role="status" data-done={done || undefined}>
          {done && <IconCircleCheck size={16} aria-label="Done." />}
          {done && lesson}
        </p>
        <Button
          ml="auto"
          size="compact-sm"
          variant={done ? "filled" : "subtle"}
          color={done ? undefined : "gray"}
          onClick={() => goTo(step + 1)}
        >
          {!done ? "Skip" : step === STEPS.length - 1 ? "End" : "Next"}
        </Button>
      </aside>
    </>
  );
}
