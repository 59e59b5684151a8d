// What the camera of the robot shows, beside the world from above.

import { Button } from "@mantine/core";
import { useMemo, useRef } from "react";

import { isPicture, portAxes } from "../model/ports";
import { paintPicture } from "../draw/paint";
import { planeIn } from "../plots/kinds/parts";
import { useStreams } from "../plots/useStreams";
import type { ElementView } from "../protocol";
import { request } from "../server/socket";
import { useStudio } from "../server/store";
import type { Wish } from "../server/streams";

const CAMERA = "camera";
const MOST = 256;
// The size of the picture of a sensor that is added.
const COLUMNS = 40;
const ROWS = 30;

// The first sensor of the document that reads a camera as a picture; null: it has none.
export function useCamera(): ElementView | null {
  return useStudio(
    ({ document }) =>
      document?.elements.find(
        (element) =>
          element.kind === "Sensor" &&
          element.values.sensor === CAMERA &&
          isPicture(portAxes(document, element, "output") ?? []),
      ) ?? null,
  );
}

// A sensor of the robot's camera for a model that has none.
export function AddCamera() {
  const axis = (name: string, samples: number) => ({ name, lower: 0, upper: samples - 1, samples });
  const axes = [axis("column", COLUMNS), axis("row", ROWS), axis("channel", 3)];
  const add = () =>
    void request({ type: "add_element", kind: "Sensor", name: CAMERA, values: { sensor: CAMERA, axes } });
  return (
    <Button
      size="compact-xs"
      variant="subtle"
      color="gray"
      title="Add a sensor to the model that reads the camera of the robot; its picture appears here"
      onClick={add}
    >
      Add its camera
    </Button>
  );
}

export function CameraView({ camera }: { camera: ElementView }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const wishes = useMemo<Wish[]>(
    () => [{ type: "watch", element: camera.id, port: "output", most: MOST }],
    [camera.id],
  );
  const { lost, seen } = useStreams(wishes, true, ([live]) => {
    const plane = live?.form?.channels === true ? planeIn(live) : null;
    if (canvas.current !== null && plane !== null) {
      paintPicture(canvas.current, plane.map.values, plane.map.nx, plane.map.ny);
    }
  });
  return (
    <figure className="world-camera">
      <div className="world-picture">
        <canvas ref={canvas} role="img" aria-label={`Picture of the camera, ${camera.path}`} />
      </div>
      <figcaption className="dim one-line" title={lost?.what ?? camera.path}>
        {lost !== null ? lost.what : seen ? camera.path : "no picture yet"}
      </figcaption>
    </figure>
  );
}
