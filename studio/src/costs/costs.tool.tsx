// The tool of costs: the time of each element in a step, measured on request.

import "./costs.css";

import { Group } from "@mantine/core";
import { IconStopwatch } from "@tabler/icons-react";

import { ProblemTexts } from "../widgets/ProblemText";
import { request } from "../server/socket";
import type { DockTool } from "../state/tool";
import { useStudio } from "../server/store";
import { PanelButton } from "../widgets/Buttons";
import { type CostRow, costRows, microsecondsText, sumOf } from "./costRows";

export const tool: DockTool = { title: "Costs", component: CostsPanel };

function CostsPanel() {
  const costs = useStudio((state) => state.costs);
  const elements = useStudio((state) => state.elements);
  const measuring = costs?.measuring ?? false;
  const rows = costs === null ? [] : costRows(costs, elements);
  const again = rows.length > 0;
  return (
    <div className="costs">
      <Group gap={6} className="small">
        <PanelButton
          label={again ? "Measure costs again" : "Measure costs"}
          icon={IconStopwatch}
          loading={measuring}
          onClick={() => void request({ type: "measure_costs" })}
        />
        {costs !== null && again && (
          <span role="status">
            A step takes {microsecondsText(costs.step)} µs; the elements, each measured alone, add up to{" "}
            {microsecondsText(sumOf(costs))} µs
          </span>
        )}
      </Group>
      <ProblemTexts problems={costs?.problems} />
      {again ? (
        <table className="table cost-table" aria-label="Time that each element takes of a step">
          <thead>
            <tr>
              <th scope="col">Element</th>
              <th scope="col">Kind</th>
              <th scope="col">µs a step</th>
              <th scope="col">Share</th>
            </tr>
          </thead>
          <tbody>
            {rows.map((row) => (
              <Line key={row.key} row={row} />
            ))}
          </tbody>
        </table>
      ) : (
        <p className="dim">
          How long each element takes in a step. The run goes on meanwhile; the first time takes about as long
          as compiling.
        </p>
      )}
    </div>
  );
}

function Line({ row }: { row: CostRow }) {
  const select = useStudio((state) => state.select);
  const { element } = row;
  return (
    <tr title={row.about}>
      <th scope="row" className="wrapped">
        {element === null ? (
          <span className="dim">{row.path}</span>
        ) : (
          <button type="button" onClick={() => select([element])}>
            {row.path}
          </button>
        )}
      </th>
      <td className="dim wrapped">{row.kind}</td>
      <td>{row.time}</td>
      <td>
        {row.share}
        <span className="cost-bar" aria-hidden="true" style={{ width: `${100 * row.bar}%` }} />
      </td>
    </tr>
  );
}
