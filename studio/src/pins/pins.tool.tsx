// The tool of sliders: parameters of any element and document parameters, side by side, kept with the
// document.

import "../forms/inspector.css";
import "./pins.css";

import { Button, Menu } from "@mantine/core";
import { useState } from "react";

import { AddButton } from "../widgets/AddButton";
import { moved } from "../model/part";
import type { DockTool } from "../state/tool";
import { request } from "../server/socket";
import { useStudio } from "../server/store";
import { MenuList } from "../widgets/MenuList";
import { KeptPresets } from "./KeptPresets";
import { PinRow } from "./PinRow";
import { isAt, usePins, withPin } from "../state/pin";
import { dropParameter } from "../actions/pinDrag";
import { keepPins } from "../actions/pinning";

export const tool: DockTool = { title: "Sliders", tab: 2, firstIn: ["run", "robot"], component: Pins };

function Pins() {
  const pins = usePins();
  const open = useStudio((state) => state.document !== null);
  const record = useStudio((state) => state.document?.record != null);
  const isEmpty = useStudio((state) => state.elements.size === 0);
  // The dragged row, and the row before which it would be placed.
  const [dragged, setDragged] = useState<number | null>(null);
  const [over, setOver] = useState<number | null>(null);

  if (!open) {
    return <div className="pins dim">No document is open.</div>;
  }
  const drop = () => {
    if (dragged !== null && over !== null) {
      keepPins((all) => moved(all, dragged, over));
    }
    setDragged(null);
    setOver(null);
  };
  return (
    <div className="pins" inert={record} {...dropParameter()}>
      {pins.length === 0 && (
        <div className="pins-empty">
          <p>
            <b>No sliders yet.</b>
          </p>
          <p>Pin a value: “…” beside it, or drag it here.</p>
          <Button size="compact-xs" disabled={isEmpty} onClick={() => void request({ type: "pin_usual" })}>
            Pin the usual five
          </Button>
        </div>
      )}
      <ul className="pin-list" aria-label="Pinned parameters">
        {pins.map((pin, i) => (
          <PinRow
            key={`${pin.element} ${pin.parameter}`}
            pin={pin}
            place={{ index: i, count: pins.length }}
            mark={over === i && dragged !== null && dragged !== i ? (dragged > i ? "before" : "after") : ""}
            onDrag={() => setDragged(i)}
            onOver={() => setOver(i)}
            onDrop={drop}
            onMove={(to) => keepPins((all) => moved(all, i, to))}
          />
        ))}
      </ul>
      <DocumentParameterMenu />
      <KeptPresets />
    </div>
  );
}

// Document parameters that have no slider yet.
function DocumentParameterMenu() {
  const document = useStudio((state) => state.document);
  const pins = usePins();
  const rest = (document?.parameters ?? []).filter(({ name }) => !pins.some((pin) => isAt(pin, "", name)));
  if (rest.length === 0) {
    return null;
  }
  return (
    <Menu position="bottom-start" shadow="md" classNames={{ dropdown: "compact-menu" }}>
      <Menu.Target>
        <AddButton>Document parameter</AddButton>
      </Menu.Target>
      <MenuList>
        {rest.map(({ name }) => (
          <Menu.Item key={name} onClick={() => keepPins((all) => withPin(all, "", name))}>
            {name}
          </Menu.Item>
        ))}
      </MenuList>
    </Menu>
  );
}
