// The views of the document, each for a task.

import { SegmentedControl } from "@mantine/core";

import { showView, usePage, type View } from "../state/page";
import { rememberView } from "../state/person";
import { useStudio } from "../store";

const DATA: { value: View; label: string }[] = [
  { value: "build", label: "Build" },
  { value: "run", label: "Run" },
  { value: "experiment", label: "Experiment" },
  { value: "robot", label: "Robot" },
];

const LABEL = { label: { padding: "3px 12px", fontSize: 13 } };

function choose(view: View): void {
  showView(view);
  rememberView(useStudio.getState().document?.file ?? "", view);
}

export function Views() {
  const view = usePage((page) => page.view);
  return (
    <SegmentedControl
      size="xs"
      aria-label="View"
      styles={LABEL}
      data={DATA}
      value={view}
      // also the view that is shown is chosen by a click
      onClick={() => choose(view)}
      onChange={choose}
    />
  );
}
