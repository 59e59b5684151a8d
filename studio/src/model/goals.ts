// What a field is tuned to: the goals of the form, as the server takes them.

export type ToleratedValue = { on: boolean; at: number; within: number };

export type Goals = {
  detection: ToleratedValue;
  width: ToleratedValue;
  // What becomes of a peak after its input, and of two equal inputs; empty: either.
  after: "" | "remembers" | "forgets";
  two: "" | "selects" | "multi_peak";
};

// With a detection threshold the inputs of the other goals are 1.2 times as strong, as where a regime is
// measured.
export const FIRST_GOALS: Goals = {
  detection: { on: true, at: 3, within: 0.2 },
  width: { on: false, at: 10, within: 1 },
  after: "",
  two: "",
};

/** The requirements, as in the files of `deodar tune`. */
export function requirements({ detection, width, after, two }: Goals): unknown[] {
  return [
    ...(detection.on ? [{ detects: { at: detection.at, within: detection.within } }] : []),
    ...(width.on ? [{ peak_width: { width: width.at, within: width.within } }] : []),
    ...(after === "" ? [] : [after]),
    ...(two === "" ? [] : [two]),
  ];
}

/** The parameters of a field that its regime depends on, and whether they are tuned by default. */
export function tunable(values: Record<string, unknown>): { name: string; usual: boolean }[] {
  const kernel = Array.isArray(values["kernel"]) ? (values["kernel"] as Record<string, unknown>[]) : [];
  const parts = kernel.flatMap((part, i) =>
    ["amplitude", "sigma"]
      .filter((name) => typeof part[name] === "number")
      .map((name) => ({ name: `kernel.${i}.${name}`, usual: true })),
  );
  const own = ["resting_level", "global_inhibition"].filter((name) => typeof values[name] === "number");
  const sigmoid = values["sigmoid"] as Record<string, unknown> | null | undefined;
  const slope = typeof sigmoid?.["beta"] === "number" ? [{ name: "sigmoid.beta", usual: false }] : [];
  return [
    ...own.map((name) => ({ name, usual: name === "resting_level" || values[name] !== 0 })),
    ...parts,
    ...slope,
  ];
}
