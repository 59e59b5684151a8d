// The pinned sliders in a box: symbol, track, number.

import { isEditable } from "../../state/editable";
import { NumberControl } from "../../forms/NumberControl";
import { words } from "../../model/part";
import type { PinView } from "../../protocol";
import { usePin } from "../../actions/usePin";
import { useStudio } from "../../server/store";
import { Tex } from "../../widgets/Tex";
import { useHover } from "../../state/hover";

const BOX_KEYS = new Set(["Delete", "Backspace", "Enter", "Escape"]);

export function BoxPins({ pins }: { pins: PinView[] }) {
  const editable = useStudio(isEditable);
  return pins.length === 0 ? null : (
    <div
      className="graph-pins nodrag nopan nokey"
      inert={!editable}
      onPointerEnter={() => useHover.getState().close()}
      // A hand on a slider does not select the box, nor open its plot.
      onClickCapture={(event) => event.stopPropagation()}
      onDoubleClickCapture={(event) => event.stopPropagation()}
      // These keys would remove, select or leave the box.
      onKeyDown={(event) => BOX_KEYS.has(event.key) && event.stopPropagation()}
    >
      {pins.map((pin) => (
        <BoxPin key={pin.parameter} pin={pin} />
      ))}
    </div>
  );
}

function BoxPin({ pin }: { pin: PinView }) {
  const { path, setting, look, rangeKey } = usePin(pin);
  const { label = words(pin.parameter.split(".").at(-1) ?? "") } = pin;
  return (
    <div className="graph-pin" title={path}>
      <span className="graph-pin-name one-line">
        {pin.label === undefined && look !== undefined && look.symbol !== "" ? (
          <Tex source={look.symbol} />
        ) : (
          label
        )}
      </span>
      {look === undefined ? (
        <span className="dim">none</span>
      ) : (
        <NumberControl
          label={pin.label ?? path}
          setting={setting}
          range={look.range}
          rangeKey={rangeKey}
          unit=""
          optional={look.optional}
        />
      )}
    </div>
  );
}
