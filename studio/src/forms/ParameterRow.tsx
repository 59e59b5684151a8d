// One parameter: its symbol and name, what a change costs, its menu, and the control.

import { Tooltip } from "@mantine/core";
import { IconLink } from "@tabler/icons-react";
import { useState, type MouseEvent, type ReactNode } from "react";

import { dragParameter } from "../actions/pinDrag";
import type { DocumentParameterView, ParameterForm } from "../protocol";
import { useStudio } from "../server/store";
import { CostMark } from "../widgets/CostMark";
import { DocumentParameterNaming } from "./DocumentParameterAdding";
import { linkable } from "../model/leaf";
import { numberText } from "../model/number";
import { hasDefault, kindOf, same, symbolOf, words } from "../model/part";
import { usePlace } from "../state/place";
import { defaultAt } from "../model/sliderRange";
import { Prose } from "../widgets/Prose";
import { RowMenu } from "./RowMenu";
import { Tex } from "../widgets/Tex";

type RowProps = {
  form: ParameterForm;
  path: string;
  value: unknown;
  onReset: (value: unknown) => void;
  driver?: DocumentParameterView;
  // In the place of the parameter's own name and symbol: an axis, a name in a table.
  label?: string;
  // A single number, which can be pinned and linked.
  leaf?: boolean;
  // The control is beside the name, not below.
  inline?: boolean;
  // A unit that has no room inside the control.
  unit?: string;
  // At the end of the first line.
  extra?: ReactNode;
  // Without a control the row is the head of the rows that follow.
  children?: ReactNode;
};

export function ParameterRow(props: RowProps) {
  const { form, path, value, driver, label, extra, children } = props;
  const { leaf = false, inline = false, unit = "" } = props;
  const { element, send } = usePlace();
  const [opened, setOpened] = useState(false);
  const [naming, setNaming] = useState(false);
  const standard = defaultAt(form, path);
  const resettable = hasDefault(form) && standard !== undefined && (standard !== null || form.optional);
  const atDefault = same(value, standard);
  const pinnable = leaf && send === undefined;
  const withMenu = resettable || pinnable;

  const onContextMenu = (event: MouseEvent) => {
    if (
      withMenu &&
      !(event.target instanceof HTMLInputElement || event.target instanceof HTMLTextAreaElement)
    ) {
      event.preventDefault();
      event.stopPropagation();
      setOpened(true);
    }
  };

  return (
    <div
      className={inline ? "row row-inline" : "row"}
      role="group"
      aria-label={path}
      aria-description={form.meaning}
      data-path={path}
      onContextMenu={onContextMenu}
    >
      <div className="row-label">
        <Tooltip
          label={<Meaning form={form} path={path} />}
          disabled={form.description === "" && form.meaning === ""}
          position="top-start"
        >
          <span
            className="row-name"
            draggable={pinnable}
            onDragStart={(event) => dragParameter(event, element, path)}
          >
            {label === undefined && symbolOf(form) !== "" && <Tex source={symbolOf(form)} />}
            <span className="one-line" title={label}>
              {label ?? words(form.name)}
            </span>
          </span>
        </Tooltip>
        {unit !== "" && <span className="fine unit">{unit}</span>}
        {resettable && !atDefault && (
          <span className="row-dot" role="img" aria-label="not the default" title="not the default" />
        )}
        {driver !== undefined && (
          <span className="row-driver" title={`Driven by the document parameter ${driver.name}`}>
            <IconLink size={11} />
            <span className="one-line">{driver.name}</span>
          </span>
        )}
        {extra !== undefined && extra !== false && <span className="row-extra">{extra}</span>}
      </div>
      {children !== undefined && <div className="row-control">{children}</div>}
      <div className="row-tools">
        {send === undefined && <CostMark element={element} path={path} cost={form.cost} />}
        {withMenu ? (
          <RowMenu
            element={element}
            path={path}
            driver={driver}
            byDefault={<DefaultText form={form} value={standard} />}
            atDefault={atDefault}
            onReset={resettable ? () => props.onReset(standard) : undefined}
            pinnable={pinnable}
            linkable={pinnable && linkable(form)}
            opened={opened}
            onOpened={setOpened}
            onName={() => setNaming(true)}
          />
        ) : (
          <span className="row-menu" />
        )}
      </div>
      {naming && (
        <DocumentParameterNaming
          element={element}
          path={path}
          suggestion={form.name}
          onDone={() => setNaming(false)}
        />
      )}
    </div>
  );
}

function Meaning({ form, path }: { form: ParameterForm; path: string }) {
  return (
    <>
      <Prose text={form.description || form.meaning} />
      <div className="meaning-path">{path}</div>
    </>
  );
}

// A default as short text; empty if it would be long.
function DefaultText({ form, value }: { form: ParameterForm; value: unknown }) {
  const kinds = useStudio((state) => state.kinds);
  switch (typeof value) {
    case "number":
      return numberText(value);
    case "boolean":
      return value ? "on" : "off";
    case "string":
      return value;
    default:
      return value === null ? form.if_none || "none" : (kindOf(kinds, value)?.title ?? "");
  }
}
