// What happened last, at the lower left. An error or an offer stays until dismissed, or until something else
// happens; anything else disappears after some time.

import { Button, CloseButton, Group } from "@mantine/core";
import { IconAlertTriangle, IconCircleCheck } from "@tabler/icons-react";
import { useEffect } from "react";

import { type Notice, useStudio } from "../server/store";
import { ProblemTexts } from "../widgets/ProblemText";
import classes from "../widgets/problems.module.css";

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
    <div className={`card ${classes.notice}`} data-level={level}>
      <Icon size={18} aria-label={level === "error" ? "Problem" : "Done"} />
      <div className="grow">
        <ProblemTexts problems={problems} />
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
