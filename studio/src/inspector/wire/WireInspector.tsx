// A connection: its ends, its strength, what is on it, and what it reads.

import { Button, UnstyledButton } from "@mantine/core";

import { isEditable } from "../../state/editable";
import { openPalette } from "../../actions/palette";
import { middleOf } from "../../actions/wires";
import { labelOf } from "../../architecture/label";
import type { Chain } from "../../architecture/chains";
import { RANGE, useStrength, wireText } from "../../actions/strength";
import { useStudio } from "../../server/store";
import { PlainRow } from "../../forms/PlainRow";
import { NumberControl } from "../../forms/NumberControl";
import type { Setting } from "../../actions/setting";

const READS: Record<string, string> = {
  current: "this step",
  previous: "the previous step",
  delayed: "one step later",
};

export function WireInspector({ wire, chain }: { wire: string; chain: Chain }) {
  const { source, source_port, target, target_port, couplings, gain, reads } = chain;
  const text = useStudio(({ elements }) => wireText(chain, elements));
  const elements = useStudio((state) => state.elements);
  const setting = useStrength(chain);
  const several = (ports: string[] | undefined, port: string) => ((ports?.length ?? 0) > 1 ? `.${port}` : "");
  const others = couplings.filter((id) => id !== gain);
  const [ends, does] = text.split(", ");
  const insert = () => {
    const at = middleOf(wire);
    if (at !== null) {
      openPalette(at, wire);
    }
  };
  return (
    <>
      <header className="inspector-header">
        <h2 className="one-line" title={ends}>
          {ends}
        </h2>
        <span className="kind-title">Connection, {does}</span>
      </header>
      <section className="parameters" aria-label="Connection">
        <PlainRow name="from">
          <ElementLink id={source} port={several(elements.get(source)?.outputs, source_port)} />
        </PlainRow>
        <PlainRow name="to">
          <ElementLink id={target} port={several(elements.get(target)?.inputs, target_port)} />
        </PlainRow>
        <div className="row" role="group" aria-label="strength">
          <div className="row-label">strength</div>
          <div className="row-control">
            <NumberControl
              label="strength"
              // a number that is not optional is never null
              setting={setting as Setting<number | null>}
              range={RANGE}
              rangeKey={wire}
              unit=""
            />
          </div>
        </div>
        {others.map((id) => (
          <PlainRow key={id} name={couplingOf(elements.get(id)?.kernel)}>
            <ElementLink id={id} port="" />
          </PlainRow>
        ))}
        {reads !== "" && <PlainRow name="reads">{READS[reads] ?? reads}</PlainRow>}
      </section>
      <Button size="compact-xs" variant="default" disabled={!useStudio(isEditable)} onClick={insert}>
        Insert an element
      </Button>
    </>
  );
}

const couplingOf = (isKernel: boolean | undefined): string => (isKernel === true ? "kernel" : "through");

function ElementLink({ id, port }: { id: string; port: string }) {
  const label = useStudio(({ elements, kinds }) => {
    const { path = "", name = "", kind = "" } = elements.get(id) ?? {};
    const called = labelOf(name, kind, kinds.get(kind)?.title ?? "");
    return called === name ? path : called;
  });
  return (
    <UnstyledButton className="link-path fine" onClick={() => useStudio.getState().select([id])}>
      {label}
      {port}
    </UnstyledButton>
  );
}
