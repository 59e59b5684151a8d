// One part of a list: a summary line and its parameters, which fold.

import { Menu, UnstyledButton } from "@mantine/core";
import { IconChevronDown, IconChevronRight, IconTrash } from "@tabler/icons-react";

import type { ParameterForm } from "../../protocol";
import { useStudio } from "../../store";
import type { Values } from "../../values";
import { DotsMenu } from "../../widgets/DotsMenu";
import { MoveItems } from "../../widgets/MoveItems";
import { kindOf, moved, recast, summary, without } from "../parameters/part";
import { PartFields } from "./PartFields";

type PartItemProps = {
  form: ParameterForm;
  path: string;
  parts: Values[];
  index: number;
  folded: boolean;
  onFold: () => void;
  commit: (parts: Values[]) => void;
};

export function PartItem({ form, path, parts, index, folded, onFold, commit }: PartItemProps) {
  const part = parts[index] ?? {};
  const kinds = useStudio((state) => state.kinds);
  const kind = kindOf(kinds, part);
  const title = kind?.title ?? String(part["kind"]);
  const others = form.of.filter((name) => name !== kind?.name);
  return (
    <section className="part-item" aria-label={path}>
      <div className="part-line">
        <UnstyledButton
          className="part-fold"
          aria-expanded={!folded}
          aria-label={`${title}, ${path}`}
          onClick={onFold}
        >
          {folded ? <IconChevronRight size={13} /> : <IconChevronDown size={13} />}
          <span className="part-title">{title}</span>
          {folded && <span className="dim one-line">{summary(kinds, part)}</span>}
        </UnstyledButton>
        <DotsMenu label={`More for ${path}`}>
          <MoveItems
            place={{ index, count: parts.length }}
            onMove={(to) => commit(moved(parts, index, to))}
          />
          <Menu.Item leftSection={<IconTrash size={14} />} onClick={() => commit(without(parts, index))}>
            Remove
          </Menu.Item>
          {others.length > 0 && <Menu.Label>Replace by</Menu.Label>}
          {others.map((name) => (
            <Menu.Item key={name} onClick={() => commit(parts.with(index, recast(kinds, name, part)))}>
              {kinds.get(name)?.title ?? name}
            </Menu.Item>
          ))}
        </DotsMenu>
      </div>
      {!folded && (
        <div className="nested">
          <PartFields kind={String(part["kind"])} values={part} prefix={`${path}.`} />
        </div>
      )}
    </section>
  );
}
