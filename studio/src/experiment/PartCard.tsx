// The card of a condition, an action or a measure: its kind, its name and the forms of its parameters.

import { IconTrash } from "@tabler/icons-react";

import { MenuEntry } from "../widgets/Buttons";
import { DotsMenu } from "../widgets/DotsMenu";
import { Fields } from "../forms/PartFields";
import { TextBox } from "../widgets/TextBox";
import { PlaceContext } from "../state/place";
import { ProblemLine } from "../widgets/ProblemLine";
import type { Kind } from "../protocol";
import { useStudio } from "../server/store";
import { succeeded } from "../files/flows";
import { edit } from "./actions";
import { type Group, type Part, remove, rename } from "./draft";
import { useCardPlace, withDefaults } from "./cardPlace";
import { problemsAt } from "./problems";

type PartCardProps = { group: Group; part: Part; kinds: Kind[]; usual: string };

export function PartCard({ group, part: { key, values }, kinds, usual }: PartCardProps) {
  const kind = kinds.find(({ name }) => name === (values["kind"] ?? usual));
  const forms = kind?.parameters ?? [];
  const place = useCardPlace(forms, values, group, key);
  return (
    <CardFrame group={group} name={key} title={kind?.title ?? String(values["kind"])} kinds={kinds}>
      <PlaceContext.Provider value={place}>
        <Fields forms={forms} values={withDefaults(values, forms)} prefix={`${key}.`} />
      </PlaceContext.Provider>
    </CardFrame>
  );
}

type CardProps = {
  group: Group;
  name: string;
  title: string;
  kinds: Kind[];
  children: React.ReactNode;
};

// The frame of a card: its title, its name, a menu, and what is wrong with it.
export function CardFrame({ group, name, title, kinds, children }: CardProps) {
  const problems = useStudio((state) => state.experiment?.problems) ?? [];
  const own = problemsAt(problems, `${group}.${name}`);
  const label = group === "actions" ? `${title} ${Number(name) + 1}` : `${title} ${name}`;
  const take = async (typed: string) =>
    typed.trim() === "" || succeeded(await edit((data) => rename(data, group, name, typed.trim(), kinds)));
  return (
    <section
      className="card down experiment-card"
      aria-label={label}
      data-wrong={own.length > 0 || undefined}
    >
      <div className="across">
        <span className="part-title">{title}</span>
        {group === "actions" ? (
          <span className="grow" />
        ) : (
          <TextBox label={`Name of ${name}`} value={name} onCommit={take} />
        )}
        <DotsMenu label={`More for ${label}`}>
          <MenuEntry
            label="Remove"
            icon={IconTrash}
            onClick={() => void edit((data) => remove(data, group, name))}
          />
        </DotsMenu>
      </div>
      {children}
      {own.map((problem, i) => (
        <ProblemLine key={i} problem={{ what: problem.what, fix: problem.fix }} />
      ))}
    </section>
  );
}
