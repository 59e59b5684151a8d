// The cards of an experiment: what differs, what is detected, what is done and what is measured.

import { Menu } from "@mantine/core";

import { AddButton } from "../widgets/AddButton";
import { Fields } from "../forms/PartFields";
import { TextBox } from "../widgets/TextBox";
import { PlaceContext } from "../state/place";
import { ProblemTexts } from "../widgets/ProblemText";
import type { ExperimentForms, Kind } from "../protocol";
import { useStudio } from "../server/store";
import { MenuList } from "../widgets/MenuList";
import { edit } from "./actions";
import { succeeded } from "../files/flows";
import { add, type Group, partsOf } from "./draft";
import { FactorCard } from "./FactorCard";
import { PartCard } from "./PartCard";
import { useCardPlace, useData, withDefaults } from "./cardPlace";
import { otherProblems } from "./problems";

const GROUPS: { group: Group; title: string; about: string }[] = [
  { group: "factors", title: "Factors", about: "what differs between trials" },
  { group: "conditions", title: "Conditions", about: "events that are detected, and may end the trial" },
  { group: "actions", title: "Actions", about: "changes during each trial, at a time or after an event" },
  { group: "measures", title: "Measures", about: "one number of each trial" },
];

// Parameters of the experiment that are always shown.
const FIRST = 2;

export function Design({ forms }: { forms: ExperimentForms }) {
  const data = useData();
  const problems = useStudio((state) => state.experiment?.problems) ?? [];
  const place = useCardPlace(forms.design, data);
  const shown = withDefaults(data, forms.design);
  const places = GROUPS.flatMap(({ group }) => partsOf(data, group).map(({ key }) => `${group}.${key}`));
  const rename = async (name: string) => succeeded(await edit((now) => ({ ...now, name: name.trim() })));
  return (
    <PlaceContext.Provider value={place}>
      <ProblemTexts problems={otherProblems(problems, places)} />
      <section aria-label="Trials" className="experiment-group">
        <div className="row row-inline">
          <div className="row-label">Name</div>
          <div className="row-control">
            <TextBox label="Name of the experiment" value={String(data["name"] ?? "")} onCommit={rename} />
          </div>
        </div>
        <Fields forms={forms.design.slice(0, FIRST)} values={shown} prefix="" />
        <details className="experiment-more">
          <summary>More settings</summary>
          <Fields forms={forms.design.slice(FIRST)} values={shown} prefix="" />
        </details>
      </section>
      {GROUPS.map(({ group, ...said }) => (
        <Cards
          key={group}
          group={group}
          {...said}
          kinds={group === "factors" ? [] : forms[group]}
          usual={group === "measures" ? forms.usual : ""}
        />
      ))}
    </PlaceContext.Provider>
  );
}

type CardsProps = { group: Group; title: string; about: string; kinds: Kind[]; usual: string };

function Cards({ group, title, about, kinds, usual }: CardsProps) {
  const data = useData();
  const parts = partsOf(data, group);
  return (
    <section aria-label={title} className="experiment-group">
      <h3>
        <span>
          {title} <span className="dim experiment-about">{about}</span>
        </span>
        <Adding group={group} title={title} kinds={kinds} usual={usual} />
      </h3>
      {parts.map((part) =>
        group === "factors" ? (
          <FactorCard key={part.key} part={part} />
        ) : (
          <PartCard key={part.key} group={group} part={part} kinds={kinds} usual={usual} />
        ),
      )}
    </section>
  );
}

function Adding({ group, title, kinds, usual }: Omit<CardsProps, "about">) {
  const insert = (kind: Kind | undefined) => {
    const name = (kind?.title ?? "factor").toLowerCase();
    const values =
      kind === undefined ? { levels: [], path: "" } : kind.name === usual ? {} : { kind: kind.name };
    void edit((data) => add(data, group, values, name));
  };
  if (kinds.length < 2) {
    return <AddButton aria-label={`Add to ${title}`} onClick={() => insert(kinds[0])} />;
  }
  return (
    <Menu position="bottom-end" classNames={{ dropdown: "compact-menu" }}>
      <Menu.Target>
        <AddButton aria-label={`Add to ${title}`} />
      </Menu.Target>
      <MenuList>
        {kinds.map((kind) => (
          <Menu.Item key={kind.name} onClick={() => insert(kind)}>
            {kind.title}
          </Menu.Item>
        ))}
      </MenuList>
    </Menu>
  );
}
