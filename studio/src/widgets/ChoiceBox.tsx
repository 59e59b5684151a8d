// One of a few words.

import { Select } from "@mantine/core";

type ChoiceBoxProps = {
  label: string;
  value: string | null;
  choices: string[] | { value: string; label: string }[];
  // Whether none may be chosen.
  optional?: boolean;
  onCommit: (value: string | null) => void;
};

export function ChoiceBox({ label, value, choices, optional = false, onCommit }: ChoiceBoxProps) {
  return (
    <Select
      className="grow"
      aria-label={label}
      data={choices}
      value={value}
      placeholder={optional ? "none" : undefined}
      clearable={optional}
      allowDeselect={optional}
      checkIconPosition="right"
      onChange={onCommit}
    />
  );
}
