// The views of the document, each for a task.

import { showView, usePage, type View } from "../state/page";
import { rememberView } from "../state/person";
import { useStudio } from "../server/store";
import { Segments } from "../widgets/Segments";

const VIEWS = { build: "Build", run: "Run", experiment: "Experiment", robot: "Robot" };

const LABEL = { label: { padding: "3px 12px", fontSize: 13 } };

function choose(view: View): void {
  showView(view);
  rememberView(useStudio.getState().document?.file ?? "", view);
}

export function Views() {
  const view = usePage((page) => page.view);
  return (
    <Segments
      label="View"
      options={VIEWS}
      styles={LABEL}
      value={view}
      // also the view that is shown is chosen by a click
      onClick={() => choose(view)}
      onChange={choose}
    />
  );
}
