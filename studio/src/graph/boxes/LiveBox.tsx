// The live picture of an element, drawn past React and shown by the live layer. It asks for data only while
// it is mounted, which is while it is visible.

import { canvasSettings } from "../../draw/canvases";
import { useComputedColorScheme } from "@mantine/core";
import { useContext, useEffect, useRef } from "react";
import { isRecord } from "../../actions/replay";
import { socket } from "../../server/socket";
import type { Live } from "../../server/streams";
import { useStudio } from "../../server/store";
import { mostSamples } from "../../architecture/boxes";
import { clear, drawLive, drawWords, type Canvas } from "./drawLive";
import { PainterContext } from "./PainterContext";

type Props = { element: string; port: string; label: string; width: number; height: number };

export function LiveBox({ element, port, label, width, height }: Props) {
  const { painter, layer } = useContext(PainterContext);
  const ref = useRef<HTMLCanvasElement>(null);
  const slot = useRef<HTMLDivElement>(null);
  const colorScheme = useComputedColorScheme();

  useEffect(() => {
    const [place, picture] = [slot.current, ref.current];
    if (place === null || picture === null) {
      return;
    }
    layer.add(place, picture);
    const canvas: Canvas = { element: picture, width, height, span: null, port };
    let form: Live["form"] = null;
    picture.getContext("2d", canvasSettings());
    clear(canvas);
    const axes = useStudio.getState().elements.get(element)?.axes[port]?.length ?? 0;
    const most = mostSamples(axes, width);
    const leave = socket.streams.subscribe({ type: "watch", element, port, most }, (live) => {
      if (live.form !== form) {
        form = live.form;
        canvas.span = null;
      }
      painter.wish(canvas, () =>
        live.lost !== null && isRecord() ? drawWords(canvas, "not recorded") : drawLive(canvas, live),
      );
    });
    return () => {
      leave();
      painter.forget(canvas);
      layer.remove(place);
    };
  }, [painter, layer, element, port, width, height, colorScheme]);

  return (
    <div ref={slot} className="graph-live" role="img" aria-label={label} style={{ width, height }}>
      <canvas ref={ref} hidden />
    </div>
  );
}
