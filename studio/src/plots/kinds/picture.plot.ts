// A picture: two dimensions and the channels red, green and blue. Its rows count from the top.

import { commonScale, edges } from "../../draw/axis";
import { isPicture } from "../../model/ports";
import type { PlotDeclaration } from "./kind";
import { planeIn } from "./parts";

const MOST = 256;

export const plot: PlotDeclaration = {
  title: "Picture",
  rank: (axes) => (isPicture(axes) ? 0 : null),
  figure: 3,
  settings: () => [],
  ports: isPicture,
  label: ({ element, port }) => `Picture at ${port} of ${element.path}`,
  file: ({ element, port }) => `${element.path} ${port}`,
  wishes: ({ element, port }) => [{ type: "watch", element: element.id, port, most: MOST }],
  content: ({ port }, [live]) => {
    const plane = live?.form?.channels === true ? planeIn(live) : null;
    return (
      plane && {
        x: { along: plane.x, range: edges(plane.x) },
        y: { along: plane.y, range: edges(plane.y), down: true },
        equal: commonScale(plane.x, plane.y) !== null,
        marks: [{ type: "picture", label: port, ...plane.map }],
      }
    );
  },
};
