// The search box of the canvas: the chosen element is selected and centred.

import { CloseButton, Combobox, TextInput, useCombobox } from "@mantine/core";
import { IconSearch } from "@tabler/icons-react";
import { useMemo, useState } from "react";
import { useStudio } from "../store";
import { find } from "./find";

type Props = { onFound: (element: string) => void; onClose: () => void };

export function Search({ onFound, onClose }: Props) {
  const elements = useStudio((state) => state.document?.elements);
  const kinds = useStudio((state) => state.kinds);
  const [text, setText] = useState("");
  const combobox = useCombobox({ opened: true });
  const found = useMemo(() => find(text, elements ?? [], kinds), [text, elements, kinds]);
  return (
    <div className="graph-search">
      <Combobox store={combobox} withinPortal={false} offset={4} onOptionSubmit={onFound}>
        <Combobox.Target>
          <TextInput
            data-autofocus
            autoFocus
            size="xs"
            placeholder="Name, path or kind"
            aria-label="Search for an element"
            leftSection={<IconSearch size={14} aria-hidden />}
            rightSection={<CloseButton size="xs" aria-label="Close the search" onClick={onClose} />}
            value={text}
            onChange={(event) => {
              setText(event.currentTarget.value);
              combobox.resetSelectedOption();
            }}
            onKeyDown={(event) => {
              if (event.key === "Escape") {
                event.stopPropagation();
                onClose();
              } else if (
                event.key === "Enter" &&
                combobox.getSelectedOptionIndex() < 0 &&
                found[0] !== undefined
              ) {
                event.preventDefault();
                onFound(found[0].element);
              }
            }}
          />
        </Combobox.Target>
        <Combobox.Dropdown>
          <Combobox.Options mah={280} style={{ overflowY: "auto" }}>
            {found.length === 0 && <Combobox.Empty>No element matches</Combobox.Empty>}
            {found.map(({ element, path, title }) => (
              <Combobox.Option key={element} value={element} title={path}>
                <div className="one-line">{path}</div>
                <div className="graph-box-kind one-line">{title}</div>
              </Combobox.Option>
            ))}
          </Combobox.Options>
        </Combobox.Dropdown>
      </Combobox>
    </div>
  );
}
