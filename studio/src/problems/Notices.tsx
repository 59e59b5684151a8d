// What happened last, at the lower left. An error or an offer stays until dismissed, or until something else
// happens; anything else disappears after some time.

import { Button, CloseButton, Group } from "@mantine/core";
import { IconAlertTriangle, IconCircleCheck } from "@tabler/icons-react";
import { useEffect } from "react";

import { type Notice, useStudio } from "../store";
import { ProblemText } from "./ProblemText";
import classes from "./Notices.module.css";

const INFO_MS = 6000;

export function Notices() {
  const notice = useStudio((state) => state.notice);
  return (
    <section className={classes.corner} aria-label="Messages" aria-live="polite">
      {notice !== null && <NoticeCard key={notice.id} notice={notice} />}
    </section>
  );
}

function NoticeCard({ notice: { level, problems, offers } }: { notice: Notice }) {
  const dismiss = useStudio((state) => state.dismiss);
  const stays = level === "error" || offers.length > 0;
  useEffect(() => {
    if (stays) {
      return;
    }
    const timer = setTimeout(dismiss, INFO_MS);
    return () => clearTimeout(timer);
  }, [stays, dismiss]);
  const Icon = level === "error" ? IconAlertTriangle : IconCircleCheck;
  return (
    <div className={classes.notice} data-level={level}>
      <Icon size={18} className={classes.icon} aria-label={level === "error" ? "Problem" : "Done"} />
      <div className={classes.text}>
        {problems.map((problem, i) => (
          <ProblemText key={i} problem={problem} />
        ))}
        <Group gap={6}>
          {offers.map(({ label, run }) => (
            <Button
              key={label}
              size="compact-xs"
              variant="light"
              mt={6}
              onClick={() => {
                dismiss();
                run();
              }}
            >
              {label}
            </Button>
          ))}
        </Group>
      </div>
      <CloseButton size="sm" aria-label="Dismiss" onClick={dismiss} />
    </div>
  );
}
