// The card of a factor: values of one parameter, or named levels that set several.

import { ActionIcon } from "@mantine/core";
import { IconX } from "@tabler/icons-react";
import type { ComponentProps } from "react";

import { AddButton } from "../widgets/AddButton";
import { Segments } from "../widgets/Segments";
import { NameBox } from "../widgets/NameBox";
import { TextBox } from "../widgets/TextBox";
import { typedValue, valueText } from "../forms/value";
import { fresh, without } from "../model/part";
import { useStudio } from "../server/store";
import type { Values } from "../model/values";
import { succeeded } from "../files/flows";
import { edit } from "./actions";
import {
  isNamed,
  mapped,
  type NamedLevels,
  omitted,
  type Part,
  partsOf,
  pathsOf,
  put,
  withNumber,
} from "./draft";
import { CardFrame } from "./PartCard";
import { parametersOf, valueAt } from "./cardPlace";

export function FactorCard({ part: { key, values } }: { part: Part }) {
  const elements = useStudio((state) => state.document?.elements) ?? [];
  const kinds = useStudio((state) => state.kinds);
  const names = parametersOf(elements, kinds);
  const named = isNamed(values["levels"]) && values["path"] === undefined;
  const commit = async (change: NewFrom<Values>) => {
    const answer = await edit((data) => {
      const now = partsOf(data, "factors").find((part) => part.key === key);
      return now === undefined ? data : put(data, "factors", key, change(now.values));
    });
    return succeeded(answer);
  };
  const how = (chosen: string) =>
    void commit(() => (chosen === "named" ? { levels: { level: {} } } : { levels: [], path: "" }));
  const factor = { name: key, names, elements, commit };
  return (
    <CardFrame group="factors" name={key} title="Factor" kinds={[]}>
      <Segments
        label={`What ${key} sets`}
        options={{ one: "One parameter", named: "Named levels" }}
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

// New values from those after all earlier changes, which may not be drawn yet.
type NewFrom<T> = (now: T) => T;

type LevelsProps = {
  name: string;
  names: string[];
  elements: Parameters<typeof valueAt>[0];
  commit: (change: NewFrom<Values>) => Promise<boolean>;
};

type OneProps = LevelsProps & { path: string; levels: unknown[] };

function One({ name, names, elements, commit, path, levels }: OneProps) {
  const set = (change: NewFrom<unknown[]>) =>
    commit((now) => (isNamed(now["levels"]) ? now : { ...now, levels: change(listed(now)) }));
  const choose = (chosen: string) => {
    const present = valueAt(elements, chosen);
    return commit((now) => ({
      levels: listed(now).length > 0 || present === undefined ? listed(now) : [present],
      path: chosen,
    }));
  };
  const next = (now: unknown[]) => {
    const [before, last] = now.slice(-2).map(Number);
    const start = Number(valueAt(elements, path) ?? 0);
    return last === undefined ? (before ?? start) + 1 : 2 * last - (before ?? 0);
  };
  return (
    <>
      <NameBox label={`Parameter of ${name}`} value={path} names={names} onCommit={choose} />
      <div className="across experiment-levels">
        {levels.map((level, i) => (
          <Level
            key={i}
            label={`Level ${i + 1} of ${name}`}
            value={valueText(level)}
            onCommit={(typed) => set((now) => now.map((old, k) => (k === i ? typedValue(typed) : old)))}
            removes={`level ${i + 1} of ${name}`}
            remove={() => set((now) => without(now, i))}
          />
        ))}
        <AddLevel name={name} add={() => set((now) => [...now, next(now)])} />
      </div>
    </>
  );
}

function Named({ name, names, elements, commit, levels }: LevelsProps & { levels: NamedLevels }) {
  const paths = pathsOf(levels);
  const set = (change: NewFrom<NamedLevels>) =>
    commit((now) => (isNamed(now["levels"]) ? { levels: change(now["levels"]) } : now));
  const labels = Object.keys(levels);
  const addPath = (path: string) =>
    set((now) => mapped(now, (level) => ({ ...level, [path]: valueAt(elements, path) ?? 0 })));
  const renamed = (old: string, typed: string) =>
    set((now) => Object.fromEntries(Object.entries(now).map(([k, v]) => [k === old ? typed : k, v])));
  const addLevel = (now: NamedLevels) => {
    const known = Object.keys(now);
    return { ...now, [fresh(known, "level")]: { ...now[known.at(-1) ?? ""] } };
  };
  return (
    <div className="experiment-scroll">
      <table className="table experiment-named">
        <thead>
          <tr>
            <th scope="col">Parameter</th>
            {labels.map((label, i) => (
              <th scope="col" key={label}>
                <Level
                  label={`Name of level ${i + 1} of ${name}`}
                  value={label}
                  onCommit={(typed) => renamed(label, typed)}
                  removes={`${label} from ${name}`}
                  remove={() => set((now) => omitted(now, label) as NamedLevels)}
                />
              </th>
            ))}
            <th>
              <AddLevel name={name} add={() => set(addLevel)} />
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
                    onCommit={(typed) => set((now) => withNumber(now, label, path, typedValue(typed)))}
                  />
                </td>
              ))}
              <td>
                <Cross
                  removes={`${path} from ${name}`}
                  remove={() => set((now) => mapped(now, (level) => omitted(level, path)))}
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

function listed({ levels }: Values): unknown[] {
  return Array.isArray(levels) ? levels : [];
}

type CrossProps = { removes: string; remove: () => unknown };

function Level({ removes, remove, ...box }: CrossProps & ComponentProps<typeof TextBox>) {
  return (
    <span className="across experiment-level">
      <TextBox {...box} />
      <Cross removes={removes} remove={remove} />
    </span>
  );
}

function AddLevel({ name, add }: { name: string; add: () => unknown }) {
  return (
    <AddButton aria-label={`Add a level to ${name}`} onClick={add}>
      Level
    </AddButton>
  );
}

function Cross({ removes, remove }: CrossProps) {
  return (
    <ActionIcon size={18} aria-label={`Remove ${removes}`} onClick={remove}>
      <IconX size={12} />
    </ActionIcon>
  );
}
