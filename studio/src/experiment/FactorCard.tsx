// The card of a factor: values of one parameter, or named levels that set several.

import { ActionIcon, SegmentedControl } from "@mantine/core";
import { IconX } from "@tabler/icons-react";

import { AddButton } from "../widgets/AddButton";
import { NameBox } from "../inspector/forms/NameBox";
import { TextBox } from "../inspector/forms/TextBox";
import { typedValue, valueText } from "../inspector/forms/value";
import { fresh, without } from "../inspector/parameters/part";
import { useStudio } from "../store";
import type { Values } from "../values";
import { edit } from "./actions";
import { isNamed, mapLevels, type NamedLevels, type Part, pathsOf, put } from "./draft";
import { CardFrame } from "./PartCard";
import { parametersOf, valueAt } from "./cardPlace";

export function FactorCard({ part: { key, values } }: { part: Part }) {
  const elements = useStudio((state) => state.document?.elements) ?? [];
  const kinds = useStudio((state) => state.kinds);
  const names = parametersOf(elements, kinds);
  const named = isNamed(values["levels"]) && values["path"] === undefined;
  const commit = async (next: Values) =>
    ((await edit((data) => put(data, "factors", key, next))).problems ?? []).length === 0;
  const how = (chosen: string) =>
    void commit(chosen === "named" ? { levels: { level: {} } } : { levels: [], path: "" });
  const factor = { name: key, names, elements, commit };
  return (
    <CardFrame group="factors" name={key} title="Factor" kinds={[]}>
      <SegmentedControl
        size="xs"
        aria-label={`What ${key} sets`}
        data={[
          { value: "one", label: "One parameter" },
          { value: "named", label: "Named levels" },
        ]}
        value={named ? "named" : "one"}
        onChange={how}
      />
      {named ? (
        <Named {...factor} levels={values["levels"] as NamedLevels} />
      ) : (
        <One {...factor} path={String(values["path"] ?? "")} levels={(values["levels"] ?? []) as unknown[]} />
      )}
    </CardFrame>
  );
}

type LevelsProps = {
  name: string;
  names: string[];
  elements: Parameters<typeof valueAt>[0];
  commit: (values: Values) => Promise<boolean>;
};

function One({
  name,
  names,
  elements,
  commit,
  path,
  levels,
}: LevelsProps & { path: string; levels: unknown[] }) {
  const set = (next: unknown[]) => commit({ levels: next, path });
  const choose = (chosen: string) => {
    const present = valueAt(elements, chosen);
    return commit({ levels: levels.length > 0 || present === undefined ? levels : [present], path: chosen });
  };
  const next = () => {
    const [before, last] = levels.slice(-2).map(Number);
    const start = Number(valueAt(elements, path) ?? 0);
    return last === undefined ? (before ?? start) + 1 : 2 * last - (before ?? 0);
  };
  return (
    <>
      <NameBox label={`Parameter of ${name}`} value={path} names={names} onCommit={choose} />
      <div className="experiment-levels">
        {levels.map((level, i) => (
          <span key={i} className="experiment-level">
            <TextBox
              label={`Level ${i + 1} of ${name}`}
              value={valueText(level)}
              onCommit={(typed) => set(levels.map((old, k) => (k === i ? typedValue(typed) : old)))}
            />
            <Cross label={`Remove level ${i + 1} of ${name}`} onClick={() => void set(without(levels, i))} />
          </span>
        ))}
        <AddButton aria-label={`Add a level to ${name}`} onClick={() => void set([...levels, next()])}>
          Level
        </AddButton>
      </div>
    </>
  );
}

function Named({ name, names, elements, commit, levels }: LevelsProps & { levels: NamedLevels }) {
  const paths = pathsOf(levels);
  const set = (next: NamedLevels) => commit({ levels: next });
  const labels = Object.keys(levels);
  const last = levels[labels.at(-1) ?? ""] ?? {};
  const addPath = (path: string) =>
    set(mapLevels(levels, (level) => ({ ...level, [path]: valueAt(elements, path) ?? 0 })));
  const renamed = (old: string, typed: string) =>
    set(Object.fromEntries(Object.entries(levels).map(([k, v]) => [k === old ? typed : k, v])));
  return (
    <div className="experiment-scroll">
      <table className="experiment-table experiment-named">
        <thead>
          <tr>
            <th scope="col">Parameter</th>
            {labels.map((label, i) => (
              <th scope="col" key={label}>
                <span className="experiment-level">
                  <TextBox
                    label={`Name of level ${i + 1} of ${name}`}
                    value={label}
                    onCommit={(typed) => renamed(label, typed)}
                  />
                  <Cross
                    label={`Remove ${label} from ${name}`}
                    onClick={() =>
                      void set(Object.fromEntries(Object.entries(levels).filter(([k]) => k !== label)))
                    }
                  />
                </span>
              </th>
            ))}
            <th>
              <AddButton
                aria-label={`Add a level to ${name}`}
                onClick={() => void set({ ...levels, [fresh(labels, "level")]: { ...last } })}
              >
                Level
              </AddButton>
            </th>
          </tr>
        </thead>
        <tbody>
          {paths.map((path) => (
            <tr key={path}>
              <th scope="row" className="one-line" title={path}>
                {path}
              </th>
              {labels.map((label) => (
                <td key={label}>
                  <TextBox
                    label={`${path} at ${label}`}
                    value={valueText(levels[label]?.[path])}
                    onCommit={(typed) =>
                      set({ ...levels, [label]: { ...levels[label], [path]: typedValue(typed) } })
                    }
                  />
                </td>
              ))}
              <td>
                <Cross
                  label={`Remove ${path} from ${name}`}
                  onClick={() =>
                    void set(
                      mapLevels(levels, (level) =>
                        Object.fromEntries(Object.entries(level).filter(([k]) => k !== path)),
                      ),
                    )
                  }
                />
              </td>
            </tr>
          ))}
        </tbody>
      </table>
      <NameBox
        label={`Add a parameter to ${name}`}
        value=""
        placeholder="add a parameter"
        names={names.filter((path) => !paths.includes(path))}
        onCommit={addPath}
      />
    </div>
  );
}

function Cross({ label, onClick }: { label: string; onClick: () => void }) {
  return (
    <ActionIcon size={18} aria-label={label} onClick={onClick}>
      <IconX size={12} />
    </ActionIcon>
  );
}
