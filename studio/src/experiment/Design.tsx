// The cards of an experiment: what differs, what is detected, what is done and what is measured.

import { Menu } from "@mantine/core";
import { useMemo } from "react";

import { AddButton } from "../widgets/AddButton";
import { Fields } from "../inspector/forms/PartFields";
import { TextBox } from "../inspector/forms/TextBox";
import { PlaceContext } from "../inspector/place";
import { ProblemText } from "../problems/ProblemText";
import type { ExperimentForms, Kind } from "../protocol";
import { useStudio } from "../store";
import { MenuList } from "../widgets/MenuList";
import { edit } from "./actions";
import { add, type Group, partsOf } from "./draft";
import { FactorCard } from "./FactorCard";
import { PartCard } from "./PartCard";
import { useData, useDesignPlace } from "./cardPlace";
import { otherProblems } from "./problems";

// Parameters of the experiment that are always shown.
const FIRST = 2;

export function Design({ forms }: { forms: ExperimentForms }) {
  const data = useData();
  const problems = useStudio((state) => state.experiment?.problems) ?? [];
  const place = useDesignPlace(forms.design);
  const shown = useMemo(
    () => Object.fromEntries(forms.design.map((p) => [p.name, data[p.name] ?? p.default])),
    [forms, data],
  );
  const groups: Group[] = ["factors", "conditions", "actions", "measures"];
  const places = groups.flatMap((group) => partsOf(data, group).map(({ key }) => `${group}.${key}`));
  const rename = async (name: string) => {
    const answer = await edit((now) => ({ ...now, name: name.trim() }));
    return (answer.problems ?? []).length === 0;
  };
  return (
    <PlaceContext.Provider value={place}>
      {otherProblems(problems, places).map((problem, i) => (
        <ProblemText key={i} problem={problem} />
      ))}
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
      <Cards group="factors" title="Factors" about="what differs between trials" kinds={[]} usual="" />
      <Cards
        group="conditions"
        title="Conditions"
        about="events that are detected, and may end the trial"
        kinds={forms.conditions}
        usual=""
      />
      <Cards
        group="actions"
        title="Actions"
        about="changes during each trial, at a time or after an event"
        kinds={forms.actions}
        usual=""
      />
      <Cards
        group="measures"
        title="Measures"
        about="one number of each trial"
        kinds={forms.measures}
        usual={forms.usual}
      />
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
    <Menu position="bottom-end" shadow="md" classNames={{ dropdown: "compact-menu" }}>
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
