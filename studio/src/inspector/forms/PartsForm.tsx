// A list of parts, such as kernels: add, remove, move, and the parameters of each below its line.

import { Menu } from "@mantine/core";
import { useState } from "react";

import { useStudio } from "../../store";
import type { Values } from "../../values";
import { AddButton } from "../../widgets/AddButton";
import { MenuList } from "../../widgets/MenuList";
import { moved, without, words } from "../parameters/part";
import { usePlace } from "../place";
import { ProblemLine } from "../../widgets/ProblemLine";
import { ParameterRow } from "../parameters/ParameterRow";
import { useSetting } from "../parameters/setting";
import { PartItem } from "./PartItem";
import type { FormProps } from "./props";

export function PartsForm({ form, path, value }: FormProps) {
  const { element } = usePlace();
  const setting = useSetting(element, path, value, form.cost);
  const kinds = useStudio((state) => state.kinds);
  const [folded, setFolded] = useState<number[]>([]);
  const parts = Array.isArray(value) ? (value as Values[]) : [];
  const commit = (next: unknown[]) => void setting.commit(next);
  const fold = (i: number) =>
    setFolded((old) => (old.includes(i) ? old.filter((k) => k !== i) : [...old, i]));
  return (
    <>
      <ParameterRow
        form={form}
        path={path}
        value={value}
        inline
        onReset={(standard) => void setting.commit(standard)}
      >
        <span className="dim grow">{parts.length === 0 ? "none" : ""}</span>
        <Menu position="bottom-end" shadow="md" classNames={{ dropdown: "compact-menu" }}>
          <Menu.Target>
            <AddButton aria-label={`Add to ${words(path)}`} />
          </Menu.Target>
          <MenuList>
            {form.of.map((name) => (
              <Menu.Item
                key={name}
                onClick={() => commit([...parts, kinds.get(name)?.example ?? { kind: name }])}
              >
                {kinds.get(name)?.title ?? name}
              </Menu.Item>
            ))}
          </MenuList>
        </Menu>
      </ParameterRow>
      {parts.map((part, i) => (
        <PartItem
          key={`${i} ${String(part["kind"])}`}
          form={form}
          path={`${path}.${i}`}
          part={part}
          place={{ index: i, count: parts.length }}
          folded={folded.includes(i)}
          onFold={() => fold(i)}
          onReplace={(next) => commit(parts.map((old, k) => (k === i ? next : old)))}
          onRemove={() => commit(without(parts, i))}
          onMove={(to) => commit(moved(parts, i, to))}
        />
      ))}
      <ProblemLine problem={setting.problem} />
    </>
  );
}
