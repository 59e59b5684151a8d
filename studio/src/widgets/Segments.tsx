// A choice among a few, all of which can be seen.

import { SegmentedControl, type SegmentedControlProps } from "@mantine/core";

type SegmentsProps<K extends string> = Omit<
  SegmentedControlProps,
  "data" | "value" | "defaultValue" | "onChange"
> & {
  label: string;
  options: Record<K, string>;
  value: K;
  onChange: (chosen: K) => void;
};

export function Segments<K extends string>({ label, options, ...rest }: SegmentsProps<K>) {
  const data = Object.entries<string>(options).map(([value, title]) => ({ value: value as K, label: title }));
  return <SegmentedControl size="xs" aria-label={label} data={data} {...rest} />;
}
