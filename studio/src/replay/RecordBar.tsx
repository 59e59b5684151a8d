// Above a record: which trial and point of a sweep is shown, and a way to run its model.

import { Button, NativeSelect, Tooltip } from "@mantine/core";
import { IconArrowsDiff, IconMovie, IconPlayerPlay } from "@tabler/icons-react";

import { compare, leave } from "../files/flows";
import type { RecordView } from "../protocol";
import { chooseCopy, useReplay } from "../actions/replay";
import classes from "./RecordBar.module.css";

const ACTIONS = [
  {
    name: "Compare",
    tip: "Show another record of this document beside this one, and find the first difference",
    Icon: IconArrowsDiff,
    run: compare,
  },
  {
    name: "Run its model",
    tip: "Open a copy of the document of this record, which runs and can be changed",
    Icon: IconPlayerPlay,
    run: () => leave({ type: "open_record_model" }),
  },
];

export function RecordBar({ record }: { record: RecordView }) {
  const copy = useReplay((state) => state.copy);
  return (
    <div className={`flow ${classes.bar}`} role="toolbar" aria-label="Record">
      <span className={`flow ${classes.mark} dim`} title={record.path}>
        <IconMovie size={16} stroke={1.6} aria-hidden="true" />
        Record{record.growing ? ", growing" : record.complete ? "" : ", incomplete"}
      </span>
      {record.copies.map(({ name, values }) => (
        <label key={name} className={`flow ${classes.choice}`}>
          <span className="one-line" title={name}>
            {name}
          </span>
          <NativeSelect
            aria-label={name}
            data={values.map((value, index) => ({ value: String(index), label: value }))}
            value={String(copy[name] ?? 0)}
            onChange={(event) => chooseCopy(name, Number(event.currentTarget.value))}
          />
        </label>
      ))}
      {ACTIONS.map(({ name, tip, Icon, run }) => (
        <Tooltip key={name} label={tip}>
          <Button
            size="compact-sm"
            variant="default"
            leftSection={<Icon size={15} />}
            className={classes.action}
            aria-label={name}
            onClick={() => void run()}
          >
            {name}
          </Button>
        </Tooltip>
      ))}
    </div>
  );
}
