// The parameter that was changed last: while it is rebuilt or recompiled, its row shows this.

import { create } from "zustand";

import { useStudio } from "../../store";

type LastChange = { element: string; parameter: string };

const useLastChange = create<LastChange>(() => ({ element: "", parameter: "" }));

export function noteChange(element: string, parameter: string): void {
  useLastChange.setState({ element, parameter });
}

// Whether the server is busy with the change of this parameter, or of something inside it.
export function useBusy(element: string, parameter: string): boolean {
  const last = useLastChange(
    (change) =>
      change.element === element &&
      (change.parameter === parameter || change.parameter.startsWith(`${parameter}.`)),
  );
  const busy = useStudio((state) => (state.clock?.busy ?? "") !== "");
  return last && busy;
}
