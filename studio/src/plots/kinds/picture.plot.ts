// A picture: two dimensions and the channels red, green and blue. Its rows count from the top.

import { commonScale, edges } from "../../draw/axis";
import { isPicture } from "../../model/ports";
import type { PlotDeclaration } from "./kind";

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
    const [[x, y], [nx, ny]] = [live?.form?.axes ?? [], live?.form?.shape ?? []];
    const values = live?.form?.channels === true ? live.frame?.values : undefined;
    if (x === undefined || y === undefined || nx === undefined || ny === undefined || values === undefined) {
      return null;
    }
    return {
      x: { along: x, range: edges(x) },
      y: { along: y, range: edges(y), down: true },
      equal: commonScale(x, y) !== null,
      marks: [{ type: "picture", label: port, values, nx, ny }],
    };
  },
};
