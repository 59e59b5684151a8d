// Notices at the lower right. Errors and offers stay until dismissed, others disappear after some time.

import { Button, CloseButton } from "@mantine/core";
import { IconAlertTriangle, IconCircleCheck } from "@tabler/icons-react";
import { useEffect } from "react";

import { type Notice, useStudio } from "../store";
import { ProblemText } from "./ProblemText";
import classes from "./Notices.module.css";

const INFO_MS = 6000;

export function Notices() {
  const notices = useStudio((state) => state.notices);
  return (
    <section className={classes.stack} aria-label="Messages" aria-live="polite">
      {notices.map((notice) => (
        <NoticeCard key={notice.id} notice={notice} />
      ))}
    </section>
  );
}

function NoticeCard({ notice: { id, level, problem, offer } }: { notice: Notice }) {
  const dismiss = useStudio((state) => state.dismiss);
  useEffect(() => {
    if (level === "error" || offer !== undefined) {
      return;
    }
    const timer = setTimeout(() => dismiss(id), INFO_MS);
    return () => clearTimeout(timer);
  }, [id, level, offer, dismiss]);
  const Icon = level === "error" ? IconAlertTriangle : IconCircleCheck;
  return (
    <div className={classes.notice} data-level={level}>
      <Icon size={18} className={classes.icon} aria-label={level === "error" ? "Problem" : "Done"} />
      <div className={classes.text}>
        <ProblemText problem={problem} />
        {offer !== undefined && (
          <Button
            size="compact-xs"
            variant="light"
            mt={6}
            onClick={() => {
              dismiss(id);
              offer.run();
            }}
          >
            {offer.label}
          </Button>
        )}
      </div>
      <CloseButton size="sm" aria-label="Dismiss" onClick={() => dismiss(id)} />
    </div>
  );
}
