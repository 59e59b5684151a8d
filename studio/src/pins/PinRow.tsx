// One pinned parameter: its label, its slider with the ends of its range, its number.

import { Tooltip, UnstyledButton } from "@mantine/core";
import { IconGripVertical, IconLink } from "@tabler/icons-react";
import { useState, type DragEvent, type KeyboardEvent } from "react";

import { CostMark } from "../widgets/CostMark";
import { NumberControl } from "../forms/NumberControl";
import { Prose } from "../widgets/Prose";
import { SwitchControl } from "../forms/SwitchControl";
import { Tex } from "../widgets/Tex";
import type { LinkView, PinView } from "../protocol";
import { useStudio } from "../server/store";
import { PinEditing } from "./PinEditing";
import { PinMenu } from "./PinMenu";
import { changedPin, endsOf, withoutPin } from "../state/pin";
import { keepPins } from "../actions/pinning";
import { usePin } from "../actions/usePin";

type PinRowProps = {
  pin: PinView;
  place: { index: number; count: number };
  mark: "" | "before" | "after";
  onDrag: () => void;
  onOver: () => void;
  onDrop: () => void;
  onMove: (to: number) => void;
};

export function PinRow({ pin, place, mark, onDrag, onOver, onDrop, onMove }: PinRowProps) {
  const { element: id, parameter } = pin;
  const { element, shared, path, setting, look, rangeKey } = usePin(pin);
  const select = useStudio((state) => state.select);
  const [editing, setEditing] = useState<"" | "range" | "label">("");
  const [off, on] = endsOf(pin);
  const unpin = () => keepPins((pins) => withoutPin(pins, id, parameter));

  const onGripKey = (event: KeyboardEvent) => {
    const step = event.key === "ArrowUp" ? -1 : event.key === "ArrowDown" ? 1 : 0;
    if (step !== 0) {
      event.preventDefault();
      onMove(place.index + step);
    }
  };
  const takeDrag = (event: DragEvent) => {
    event.preventDefault();
    onOver();
  };

  return (
    <li
      className={`pin ${mark === "" ? "" : `pin-${mark}`}`}
      data-pin={path}
      onDragOver={takeDrag}
      onDrop={onDrop}
    >
      <div className="pin-line">
        <UnstyledButton
          className="pin-grip"
          draggable
          aria-label={`Move ${path}; arrow keys move it up and down`}
          onDragStart={(event) => {
            event.dataTransfer.effectAllowed = "move";
            event.dataTransfer.setData("text/plain", path);
            onDrag();
          }}
          onDragEnd={onDrop}
          onKeyDown={onGripKey}
        >
          <IconGripVertical size={13} />
        </UnstyledButton>
        <Tooltip
          label={<Explanation path={path} meaning={look?.meaning ?? ""} links={shared?.links ?? []} />}
          position="top-start"
        >
          <UnstyledButton
            className="pin-name"
            onClick={() => select(id === "" ? [] : [id])}
            onDoubleClick={() => setEditing("label")}
          >
            {look !== undefined && look.symbol !== "" && id !== "" && <Tex source={look.symbol} />}
            <PinName pin={pin} path={element?.path ?? ""} />
          </UnstyledButton>
        </Tooltip>
        {shared !== undefined && (
          <span className="row-driver">
            <IconLink size={11} />
            <span className="one-line">{id === "" ? `drives ${shared.links.length}` : shared.name}</span>
          </span>
        )}
        <span className="row-tools">
          <CostMark
            element={shared === undefined ? id : ""}
            path={shared?.name ?? parameter}
            cost={look?.cost ?? "live"}
          />
          <PinMenu
            path={path}
            place={place}
            ranged={pin.lower !== undefined || pin.upper !== undefined}
            onEdit={setEditing}
            onAutomatic={() =>
              keepPins((pins) => changedPin(pins, pin, { lower: undefined, upper: undefined }))
            }
            switched={pin.switch === true}
            onSwitch={(next) =>
              keepPins((pins) => changedPin(pins, pin, { switch: next ? true : undefined }))
            }
            onMove={onMove}
            onUnpin={unpin}
          />
        </span>
      </div>
      {look === undefined ? (
        <p className="pin-gone">This parameter is no longer in the document.</p>
      ) : pin.switch === true ? (
        <SwitchControl label={pin.label ?? path} setting={setting} off={off} on={on} />
      ) : (
        <NumberControl
          label={pin.label ?? path}
          setting={setting}
          range={look.range}
          rangeKey={rangeKey}
          unit={look.unit}
          optional={look.optional}
          onRange={() => setEditing("range")}
        />
      )}
      {editing !== "" && look !== undefined && (
        <PinEditing key={editing} what={editing} pin={pin} range={look.range} onDone={() => setEditing("")} />
      )}
    </li>
  );
}

// The end of a path is the most specific part: the beginning is cut first.
function PinName({ pin, path }: { pin: PinView; path: string }) {
  if (pin.label !== undefined) {
    return <span className="one-line pin-label">{pin.label}</span>;
  }
  return (
    <span className="pin-path">
      {path !== "" && <span className="one-line pin-element">{path}</span>}
      <span className="one-line pin-label">{path === "" ? pin.parameter : `.${pin.parameter}`}</span>
    </span>
  );
}

function Explanation({ path, meaning, links }: { path: string; meaning: string; links: LinkView[] }) {
  const elements = useStudio((state) => state.elements);
  const drives = links.map((link) => `${elements.get(link.element)?.path ?? link.element}.${link.parameter}`);
  return (
    <>
      <Prose text={meaning} />
      <div className="meaning-path">{path}</div>
      {drives.length > 0 && (
        <>
          Drives
          {drives.map((driven) => (
            <div className="meaning-path" key={driven}>
              {driven}
            </div>
          ))}
        </>
      )}
    </>
  );
}
