// The button that does what a problem proposes, as one step of undo. Absent where the person has to decide.

import { Button } from "@mantine/core";
import { useState } from "react";

import type { ListedProblem } from "../protocol";
import { request } from "../socket";

export function RepairButton({ problem: { repair = "", where = "", what } }: { problem: ListedProblem }) {
  const [busy, setBusy] = useState(false);
  if (repair === "") {
    return null;
  }
  return (
    <Button
      size="compact-xs"
      variant="default"
      mt={6}
      loading={busy}
      onClick={() => {
        setBusy(true);
        void request({ type: "repair", where, what }).finally(() => setBusy(false));
      }}
    >
      {repair}
    </Button>
  );
}
