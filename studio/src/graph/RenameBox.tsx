// The name of an element or a group as a text field, in its place.

import { TextInput } from "@mantine/core";
import { useState } from "react";

import { focusBox } from "../actions/made";
import { type Renaming, rename, useRenaming } from "../actions/renaming";

export function RenameBox() {
  const renaming = useRenaming((state) => state.renaming);
  return renaming === null ? null : <Field renaming={renaming} />;
}

function Field({ renaming }: { renaming: Renaming }) {
  const [text, setText] = useState(renaming.name);
  const { x, y, width, height } = renaming.at;
  const leave = () => {
    useRenaming.setState({ renaming: null });
    focusBox(renaming.element, 0);
  };
  return (
    <TextInput
      className="rename-box"
      size="xs"
      aria-label={`New name of ${renaming.name}`}
      autoFocus
      style={{ left: x - 10, top: y + height / 2 - 15, width: width + 20 }}
      value={text}
      onChange={(event) => setText(event.currentTarget.value)}
      onFocus={(event) => event.currentTarget.select()}
      onBlur={() => void rename(renaming, text)}
      onKeyDown={(event) => {
        event.stopPropagation();
        if (event.key === "Enter") {
          void rename(renaming, text);
          focusBox(renaming.element, 0);
        } else if (event.key === "Escape") {
          leave();
        }
      }}
    />
  );
}
