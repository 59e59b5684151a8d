// Tune a field to a regime: what it is to do, the parameters that may change, and what was found.

import { Button, Checkbox, Group, NativeSelect } from "@mantine/core";
import { IconCheck, IconPlayerStop, IconTarget } from "@tabler/icons-react";
import { useState } from "react";

import { ProblemText } from "../widgets/ProblemText";
import type { ElementView, Tuning } from "../protocol";
import { request } from "../server/socket";
import { useStudio } from "../server/store";
import { NumberField } from "../widgets/NumberField";
import { FIRST_GOALS, type ToleratedValue, requirements, tunable } from "../model/goals";

export function TuneSection({ field }: { field: ElementView }) {
  const tuning = useStudio((state) => state.tuning);
  const [goals, setGoals] = useState(FIRST_GOALS);
  const [chosen, setChosen] = useState<Record<string, boolean>>({});
  const [tries, setTries] = useState(0);
  const known = tunable(field.values);
  const parameters = known.filter(({ name, usual }) => chosen[name] ?? usual).map(({ name }) => name);
  const wanted = requirements(goals);
  const tune = (seed: number) => {
    setTries(seed);
    void request({ type: "tune_field", element: field.id, parameters, requirements: wanted, seed });
  };
  const own = tuning !== null && tuning.element === field.id ? tuning : null;
  return (
    <section className="tune" aria-label="Tune to a regime">
      <h3>Tune to a regime</h3>
      <ToleratedGoal
        label="detection threshold"
        value={goals.detection}
        change={(detection) => setGoals({ ...goals, detection })}
      />
      <ToleratedGoal
        label="width of the peak"
        value={goals.width}
        change={(width) => setGoals({ ...goals, width })}
      />
      <NativeSelect
        size="xs"
        label="after its input a peak"
        value={goals.after}
        onChange={(event) => setGoals({ ...goals, after: event.currentTarget.value as typeof goals.after })}
        data={[
          { value: "", label: "may do either" },
          { value: "remembers", label: "stays (working memory)" },
          { value: "forgets", label: "vanishes" },
        ]}
      />
      <NativeSelect
        size="xs"
        label="two equal inputs"
        value={goals.two}
        onChange={(event) => setGoals({ ...goals, two: event.currentTarget.value as typeof goals.two })}
        data={[
          { value: "", label: "may do either" },
          { value: "selects", label: "end in one peak (selection)" },
          { value: "multi_peak", label: "each have a peak" },
        ]}
      />
      <fieldset className="tune-parameters">
        <legend>may change</legend>
        {known.map(({ name, usual }) => (
          <Checkbox
            key={name}
            size="xs"
            label={name}
            checked={chosen[name] ?? usual}
            onChange={(event) => setChosen({ ...chosen, [name]: event.currentTarget.checked })}
          />
        ))}
      </fieldset>
      <div className="regime-head">
        {own?.tuning === true ? (
          <Button
            size="compact-sm"
            variant="default"
            leftSection={<IconPlayerStop size={15} />}
            onClick={() => void request({ type: "stop_tuning" })}
          >
            Stop tuning
          </Button>
        ) : (
          <Button
            size="compact-sm"
            variant="default"
            leftSection={<IconTarget size={15} />}
            disabled={wanted.length === 0 || parameters.length === 0}
            onClick={() => tune(0)}
          >
            Tune
          </Button>
        )}
        {wanted.length === 0 && <span className="dim">Choose what the field is to do.</span>}
        {own?.tuning === true && (
          <span className="dim" role="status">
            {own.candidates === 0 ? "Compiling" : `${own.candidates} candidates`}
          </span>
        )}
      </div>
      {(own?.problems ?? []).map((problem, i) => (
        <ProblemText key={i} problem={problem} />
      ))}
      {own !== null && own.values.length > 0 && <Found tuning={own} again={() => tune(tries + 1)} />}
    </section>
  );
}

function ToleratedGoal({
  label,
  value,
  change,
}: {
  label: string;
  value: ToleratedValue;
  change: (value: ToleratedValue) => void;
}) {
  const number = (name: "at" | "within", text: string) => (
    <NumberField
      className="tune-number"
      label={`${label}, ${text}`}
      labelled={false}
      disabled={!value.on}
      value={value[name]}
      set={(typed) => change({ ...value, [name]: typed })}
    />
  );
  return (
    <div className="tune-range">
      <Checkbox
        size="xs"
        label={label}
        checked={value.on}
        onChange={(event) => change({ ...value, on: event.currentTarget.checked })}
      />
      {number("at", "value")}
      <span>±</span>
      {number("within", "tolerance")}
    </div>
  );
}

const short = (value: number) => Number(value.toPrecision(5)).toString();

function Found({ tuning, again }: { tuning: Tuning; again: () => void }) {
  const share = (100 * tuning.tolerated).toFixed(1);
  const met = tuning.requirements.every((one) => one.margin !== null && one.margin >= 0);
  return (
    <div className="tune-found">
      <p className={met ? "regime-words" : "regime-stale"} role="status">
        {met
          ? `All requirements are met; all parameters may change by ${share} % at once.`
          : "Not all requirements are met. These are the best values that were found."}
      </p>
      {tuning.reasons.map((reason) => (
        <p key={reason} className="dim">
          {reason}
        </p>
      ))}
      <ul className="tune-sentences" aria-label="Requirements">
        {tuning.requirements.map((one) => (
          <li key={one.text} className={one.margin !== null && one.margin >= 0 ? "" : "regime-stale"}>
            {one.sentence}
          </li>
        ))}
      </ul>
      <table className="regime-table numbers">
        <caption>Values found</caption>
        <tbody>
          {tuning.values.map((one) => (
            <tr key={one.path}>
              <th scope="row">{one.path}</th>
              <td>
                {short(one.before)} → {short(one.value)}
              </td>
            </tr>
          ))}
        </tbody>
      </table>
      <Group gap="xs" justify="flex-start">
        <Button size="compact-sm" variant="default" onClick={again}>
          Try again
        </Button>
        <Button
          size="compact-sm"
          leftSection={<IconCheck size={15} />}
          disabled={tuning.applied}
          onClick={() => void request({ type: "apply_tuning" })}
        >
          {tuning.applied ? "The field has these values" : "Keep"}
        </Button>
      </Group>
    </div>
  );
}
