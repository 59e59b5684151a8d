// Where the next run computes its trials: processes of this machine, or the workers of a cluster.

import { Checkbox, TextInput } from "@mantine/core";
import type { ChangeEvent } from "react";

import { useStudio } from "../server/store";
import { Segments } from "../widgets/Segments";
import { NumberField } from "../widgets/NumberField";
import { PATIENCE, placeText, useRunPlace } from "./runPlace";

export function Where() {
  const place = useRunPlace();
  const usual = useStudio((state) => state.welcome?.usual_workers) ?? 1;
  return (
    <details className="experiment-more experiment-where">
      <summary>Where: {placeText(place, usual)}</summary>
      <Segments
        fullWidth
        label="Where the trials run"
        options={{ machine: "This machine", cluster: "A cluster" }}
        value={place.on}
        onChange={(on) => useRunPlace.setState({ on })}
      />
      {place.on === "machine" ? <Processes /> : <ClusterForm />}
    </details>
  );
}

function Processes() {
  const workers = useRunPlace((place) => place.workers);
  const usual = useStudio((state) => state.welcome?.usual_workers) ?? 1;
  const most = useStudio((state) => state.welcome?.most_workers) ?? usual;
  return (
    <NumberField
      label="Processes"
      description="Each uses one core; at most one for each batch of trials."
      lower={1}
      upper={most}
      whole
      placeholder={String(usual)}
      value={workers}
      set={(value) => useRunPlace.setState({ workers: value })}
      clear={() => useRunPlace.setState({ workers: null })}
    />
  );
}

function ClusterForm() {
  const { address, patience } = useRunPlace();
  const free = useStudio((state) => state.welcome?.clusters) ?? false;
  return (
    <>
      <TextInput
        label="Address"
        description={free ? ADDRESSES : ONLY_LOCAL}
        size="xs"
        placeholder="local:4"
        autoComplete="off"
        spellCheck={false}
        value={address}
        onChange={(event) => useRunPlace.setState({ address: event.currentTarget.value })}
      />
      <NumberField
        label="Patience"
        description="Time without any worker after which the run ends; a day in a queue is 86400 s."
        lower={1}
        upper={1e7}
        unit="s"
        value={patience}
        set={(value) => useRunPlace.setState({ patience: value })}
        clear={() => useRunPlace.setState({ patience: PATIENCE })}
      />
      <Allowed of="trust" label="Trust the network" description={TRUST} />
      <Allowed of="mixed" label="Mixed machines" description={MIXED} />
    </>
  );
}

function Allowed({ of, ...said }: { of: "trust" | "mixed"; label: string; description: string }) {
  const checked = useRunPlace((place) => place[of]);
  const change = (event: ChangeEvent<HTMLInputElement>) =>
    useRunPlace.setState({ [of]: event.currentTarget.checked });
  return <Checkbox {...said} size="xs" checked={checked} onChange={change} />;
}

const ADDRESSES =
  "local:N, the scheduler at tcp://HOST:PORT or tls://HOST:PORT, or the jobs that slurm:FILE states.";
const ONLY_LOCAL =
  "Only local:N processes: this studio can be reached from other machines, or without a token.";
const TRUST =
  "Without encryption, anyone in it who can connect to a scheduler or a worker can run programs there.";
const MIXED = "Processors may differ, and so may the last digits: each row names its machine.";
