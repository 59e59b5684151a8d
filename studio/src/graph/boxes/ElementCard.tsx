// The tooltip of an element: kind, equation, main values and problems.

import { Popover } from "@mantine/core";
import { useEffect } from "react";
import { Tex } from "../../widgets/Tex";
import { useStudio } from "../../server/store";
import { facts } from "../../model/facts";
import { useHover } from "../../state/hover";
import { MarkIcon } from "../../problems/Mark";
import { useProblem, useWarning } from "../../state/problem";

export function ElementCard() {
  const target = useHover((state) => state.target);
  const { stay, leave, close } = useHover.getState();
  useEffect(() => {
    const closeByKey = (event: KeyboardEvent) => event.key === "Escape" && close();
    window.addEventListener("keydown", closeByKey);
    return () => {
      window.removeEventListener("keydown", closeByKey);
      close();
    };
  }, [close]);
  if (target === null) {
    return null;
  }
  const { element, left, top, width, height } = target;
  return (
    <Popover
      key={element}
      opened
      position="right-start"
      offset={10}
      width={290}
      shadow="md"
      withinPortal
      trapFocus={false}
      returnFocus={false}
      closeOnEscape={false}
    >
      <Popover.Target>
        <div aria-hidden style={{ position: "fixed", left, top, width, height, pointerEvents: "none" }} />
      </Popover.Target>
      <Popover.Dropdown className="graph-card" onPointerEnter={stay} onPointerLeave={leave} role="tooltip">
        <Said element={element} />
      </Popover.Dropdown>
    </Popover>
  );
}

function Said({ element: id }: { element: string }) {
  const element = useStudio((state) => state.elements.get(id));
  const kinds = useStudio((state) => state.kinds);
  const document = useStudio((state) => state.document);
  const problem = useProblem(id);
  const warning = useWarning(id);
  const kind = kinds.get(element?.kind ?? "");
  if (element === undefined || document === null) {
    return null;
  }
  return (
    <>
      <div className="graph-card-path">{element.path}</div>
      <div className="graph-box-kind">{kind?.title ?? element.kind}</div>
      {problem !== "" && (
        <div className="graph-card-problem">
          <MarkIcon problem size={14} />
          <span>{problem}</span>
        </div>
      )}
      {warning !== "" && (
        <div className="graph-card-problem" data-warning>
          <MarkIcon problem={false} size={14} />
          <span>{warning}</span>
        </div>
      )}
      {(kind?.equation ?? []).map((line) => (
        <div key={line} className="graph-card-equation">
          <Tex source={line} />
        </div>
      ))}
      {kind !== undefined && (
        <dl className="graph-card-facts">
          {facts(element, kind, kinds, document).map(({ name, label, symbol, value }) => (
            <div key={name}>
              <dt title={label}>
                <span className="one-line">{label}</span>
                {symbol !== "" && <Tex source={symbol} />}
              </dt>
              <dd className="numbers">{value}</dd>
            </div>
          ))}
        </dl>
      )}
    </>
  );
}
