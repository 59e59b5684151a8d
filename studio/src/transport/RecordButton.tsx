// Records what is plotted or chosen into a new folder; a second press ends the record.

import { IconPlayerRecordFilled, IconPlayerStopFilled } from "@tabler/icons-react";
import { useEffect, useRef } from "react";

import { leave } from "../files/flows";
import { plottedPorts } from "../actions/openPlot";
import { request } from "../server/socket";
import { useStudio } from "../server/store";
import { TipButton } from "../widgets/TipButton";
import { RecordMenu } from "./RecordMenu";
import { unitText } from "../model/format";
import { useRecordChoice } from "./recordChoice";
import classes from "./Transport.module.css";

export function RecordButton() {
  const recording = useStudio((state) => state.clock?.recording ?? null);
  const open = recording !== null && recording.ended === "";
  useEnding(recording?.path ?? "", recording?.ended ?? "");
  const unit = useStudio((state) => unitText(state.document?.time_unit ?? ""));
  const { ports, every } = useRecordChoice();
  const what = ports === null ? "what is plotted" : "the ports chosen";
  const when = every === null ? "at every step" : `every ${every}${unit === "" ? "" : ` ${unit}`}`;
  const label = open ? `Stop recording into ${recording.path}` : `Record ${what}, ${when}, into a new folder`;
  const press = () =>
    request(open ? { type: "stop_record" } : { type: "start_record", ports: ports ?? plottedPorts(), every });
  return (
    <>
      <TipButton
        tip={label}
        aria-label={open ? "Stop recording" : "Record"}
        aria-pressed={open}
        size={28}
        color="red"
        variant={open ? "filled" : "subtle"}
        className={classes.record}
        onClick={() => void press()}
      >
        {open ? <IconPlayerStopFilled size={16} /> : <IconPlayerRecordFilled size={16} />}
      </TipButton>
      <RecordMenu disabled={open} />
    </>
  );
}

// States where a record is, and why it ended, when it ends while the page is open.
function useEnding(path: string, ended: string): void {
  const before = useRef("");
  useEffect(() => {
    if (before.current === path && path !== "" && ended !== "") {
      const reason = ended === "closed" ? "" : `, which ended early: ${ended}`;
      const offer = { label: "Open the record", run: () => leave({ type: "open_file", path }) };
      useStudio.getState().notify({ what: `Recorded into ${path}${reason}` }, "info", offer);
    }
    before.current = ended === "" ? path : "";
  }, [path, ended]);
}
