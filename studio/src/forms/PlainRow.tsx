// A row of the inspector that is no parameter: a name, and beside it a control or a text.

import type { ReactNode } from "react";

export function PlainRow({ name, children }: { name: string; children: ReactNode }) {
  return (
    <div className="row row-inline">
      <div className="row-label">{name}</div>
      <div className="row-control">{children}</div>
    </div>
  );
}
