// What a change of this parameter costs, as long as it costs anything; while it is being paid, that.

import { Loader, Tooltip } from "@mantine/core";
import { IconRefresh, IconSettingsAutomation } from "@tabler/icons-react";

import type { ParameterForm } from "../protocol";
import { pageStore } from "../state/pageStore";
import { useStudio } from "../server/store";

const COSTS = {
  rebuild: { text: "Rebuilds the kernel; takes effect at once", Icon: IconRefresh },
  recompile: { text: "Recompiles in the background; the state is kept", Icon: IconSettingsAutomation },
};

export function CostMark({
  element,
  path,
  cost,
}: {
  element: string;
  path: string;
  cost: ParameterForm["cost"];
}) {
  const busy = useBusy(element, path);
  if (busy) {
    return <Loader size={12} role="img" aria-label="Being made" />;
  }
  if (cost === "live") {
    return null;
  }
  const { text, Icon } = COSTS[cost];
  return (
    <Tooltip label={text}>
      <span className="cost-mark" role="img" aria-label={text}>
        <Icon size={12} stroke={1.6} />
      </span>
    </Tooltip>
  );
}

type LastChange = { element: string; parameter: string };

const useLastChange = pageStore<LastChange>(() => ({ element: "", parameter: "" }));

export function noteChange(element: string, parameter: string): void {
  useLastChange.setState({ element, parameter });
}

// Whether the server is busy with the change of this parameter, or of something inside it.
function useBusy(element: string, parameter: string): boolean {
  const last = useLastChange(
    (change) =>
      change.element === element &&
      (change.parameter === parameter || change.parameter.startsWith(`${parameter}.`)),
  );
  const busy = useStudio((state) => (state.clock?.busy ?? "") !== "");
  return last && busy;
}
