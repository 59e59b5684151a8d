// The lines of the report. Arrow keys lead from line to line; Enter or a click shows the element or the group
// of a line.

import { memo } from "react";

import { usePicked } from "../actions/picked";
import { type CanvasGoal, showGoal } from "../actions/showGoal";
import { useStudio } from "../server/store";
import { choosing, useOptions } from "../widgets/useOptions";
import type { ReportItem, ReportLine } from "./reportItems";

// `most` is the number of lines to draw.
type Props = { items: ReportItem[]; most: number };

export const ReportList = memo(function ReportList({ items, most }: Props) {
  const drawn = first(items, most);
  const keys = drawn.flatMap(({ lines }) => lines.map(({ key }) => key));
  const { active, setLast, onKeyDown } = useOptions(keys);
  return (
    <div className="report-list" role="listbox" aria-label="Lines of the report" onKeyDown={onKeyDown}>
      {drawn.map((item) => (
        <Item
          key={item.key}
          item={item}
          active={item.lines.some(({ key }) => key === active) ? active : null}
          onFocus={setLast}
        />
      ))}
    </div>
  );
});

// The items up to a number of lines.
function first(items: ReportItem[], most: number): ReportItem[] {
  let left = most;
  return items.flatMap((item) => {
    const lines = item.lines.slice(0, Math.max(0, left));
    left -= lines.length;
    return lines.length === 0 ? [] : [{ ...item, lines }];
  });
}

type ItemProps = {
  item: ReportItem;
  active: string | null | undefined;
  onFocus: (key: string) => void;
};

function Item({ item, active, onFocus }: ItemProps) {
  const { goal, title, note, lines } = item;
  const element = goal !== null && "element" in goal ? goal.element : null;
  const group = goal !== null && "group" in goal ? goal.group : null;
  const selected = useStudio((state) => element !== null && state.selected.includes(element));
  const picked = usePicked((state) => group !== null && state.groups.includes(group));
  return (
    <div role="group" aria-label={note === "" ? title : `${title} (${note})`} className="report-item">
      <div className="wrapped report-title" aria-hidden data-shown={selected || picked || undefined}>
        <b>{title}</b>
        {note !== "" && <span className="dim">{note}</span>}
      </div>
      {lines.map((line) => (
        <LineOption key={line.key} line={line} goal={goal} active={line.key === active} onFocus={onFocus} />
      ))}
    </div>
  );
}

type LineProps = {
  line: ReportLine;
  goal: CanvasGoal | null;
  active: boolean;
  onFocus: (key: string) => void;
};

const LineOption = memo(function LineOption({ line, goal, active, onFocus }: LineProps) {
  const { part, what, verdict, why } = line;
  const show = () => goal !== null && showGoal(goal);
  return (
    <div
      className="wrapped report-line"
      role="option"
      tabIndex={active ? 0 : -1}
      aria-selected={active}
      data-leads={goal !== null || undefined}
      onFocus={() => onFocus(line.key)}
      {...choosing(show)}
    >
      <span className="dim" data-verdict={verdict}>
        {verdict}
      </span>
      <span>
        <span className="dim">{part}</span> {what}
      </span>
      {why !== "" && <span className="report-why dim">{why}</span>}
    </div>
  );
});
