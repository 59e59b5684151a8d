// Unsaved edits that were stored when the studio ended.

import { IconRestore } from "@tabler/icons-react";

import { leave } from "../files/flows";
import { belowRoot } from "../model/paths";
import { whenText } from "../model/when";
import type { Recovery } from "../protocol";
import { request } from "../server/socket";
import { useStudio } from "../server/store";
import { PanelButton } from "../widgets/Buttons";

export function RecoveryCard({ recovery, open = false }: { recovery: Recovery; open?: boolean }) {
  const { name, title, file, when, experiment } = recovery;
  const what = experiment === "" ? title : `the experiment ${experiment}`;
  return (
    <section
      className={open ? "banner" : "banner card"}
      aria-label={`Unsaved edits${open ? "" : ` of ${what}`}`}
    >
      <IconRestore size={18} stroke={1.6} aria-hidden="true" />
      <div className="wrapped">
        Unsaved edits of <b>{what}</b>, stored {whenText(when, new Date())}, were found.
        {!open && <div className="dim small">{file}</div>}
      </div>
      <PanelButton label="Open them" variant="filled" onClick={() => void leave({ type: "recover", name })} />
      <PanelButton label="Discard" onClick={() => void request({ type: "forget", name })} />
    </section>
  );
}

// Those of the file that is open.
export function RecoveryBar() {
  const file = useStudio((state) => state.document?.file ?? "");
  const root = useStudio((state) => state.welcome?.root ?? "");
  const recoveries = useStudio((state) => state.gallery?.recoveries);
  const recovery = recoveries?.find((one) => file !== "" && belowRoot(root, one.file) === file);
  return recovery === undefined ? null : <RecoveryCard recovery={recovery} open />;
}
