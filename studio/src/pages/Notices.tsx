// What the studio has to say, at the lower right: errors stay until they are put away, the rest goes by itself.

import { CloseButton } from "@mantine/core";
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

function NoticeCard({ notice: { id, level, problem } }: { notice: Notice }) {
  const dismiss = useStudio((state) => state.dismiss);
  useEffect(() => {
    if (level === "error") {
      return;
    }
    const timer = setTimeout(() => dismiss(id), INFO_MS);
    return () => clearTimeout(timer);
  }, [id, level, dismiss]);
  const Icon = level === "error" ? IconAlertTriangle : IconCircleCheck;
  return (
    <div className={classes.notice} data-level={level}>
      <Icon size={18} className={classes.icon} aria-label={level === "error" ? "Problem" : "Done"} />
      <div className={classes.text}>
        <ProblemText problem={problem} />
      </div>
      <CloseButton size="sm" aria-label="Dismiss" onClick={() => dismiss(id)} />
    </div>
  );
}
