// Several elements: the parameters that they share, which change together.

import { useMemo } from "react";
import { useShallow } from "zustand/react/shallow";

import { socket } from "../../server/socket";
import { useStudio } from "../../server/store";
import { common } from "../../forms/common";
import { FORMS } from "../../forms/forms";
import { axesOf } from "../../model/leaf";
import { type Place, PlaceContext, useAxes } from "../../state/place";

export function ManyInspector({ ids }: { ids: string[] }) {
  const elements = useStudio(useShallow((state) => ids.flatMap((id) => state.elements.get(id) ?? [])));
  const kinds = useStudio((state) => state.kinds);
  const { axes, timeUnit } = useAxes();
  const links = useStudio((state) => state.document?.parameters)?.flatMap((parameter) => parameter.links);
  const shared = useMemo(() => common(elements, kinds), [elements, kinds]);
  // what a document parameter drives changes there
  const free = shared.filter(
    ({ form: { name } }) =>
      links?.some((link) => ids.includes(link.element) && isBelow(link.parameter, name)) !== true,
  );
  const [first] = elements;
  const place = useMemo(
    (): Place => ({
      element: first?.id ?? "",
      send: async (parameter, value, gesture) =>
        (await socket.ask({ type: "set_many", elements: ids, parameter, value, gesture })).answer,
      timeUnit,
      ...(first === undefined ? { axes: [], own: false } : axesOf(first, kinds.get(first.kind), axes)),
    }),
    [first, ids, timeUnit, kinds, axes],
  );
  const titles = [...new Set(elements.map(({ kind }) => kinds.get(kind)?.title ?? kind))];
  return (
    <PlaceContext.Provider value={place}>
      <header className="inspector-header">
        <h2 className="one-line">{elements.length} elements</h2>
        <span className="kind-title one-line" title={titles.join(", ")}>
          {titles.join(", ")}
        </span>
      </header>
      <p className="dim many-hint">A change of a parameter applies to all of them.</p>
      <section className="parameters" aria-label="Parameters">
        {free.map(({ form, value, differs }) => {
          const Form = FORMS[form.form];
          return (
            <div key={form.name} className="many-parameter" data-differs={differs || undefined}>
              {differs && <p className="dim many-differs">{form.name.replaceAll("_", " ")}: values differ</p>}
              <Form form={form} path={form.name} value={value} />
            </div>
          );
        })}
        {free.length === 0 && <p className="dim">These elements share no parameters.</p>}
      </section>
    </PlaceContext.Provider>
  );
}

const isBelow = (path: string, name: string): boolean => path === name || path.startsWith(`${name}.`);
