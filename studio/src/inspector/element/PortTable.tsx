// The ports of an element, inputs and outputs, with their axes.

import type { AxisView, ElementView, Kind } from "../../protocol";
import { Prose } from "../../widgets/Prose";

type PortTableProps = { element: ElementView; kind: Kind; axes: AxisView[] };

export function PortTable({ element, kind, axes }: PortTableProps) {
  const over = (port: string): string => {
    const keys = element.axes[port];
    if (keys === undefined) {
      return "";
    }
    return keys.length === 0
      ? "a number"
      : keys.map((key) => axes.find((axis) => axis.key === key)?.name ?? key).join(" × ");
  };
  const rows = [
    ...element.inputs.map((port) => ["in", port] as const),
    ...element.outputs.map((port) => ["out", port] as const),
  ];
  if (rows.length === 0) {
    return null;
  }
  return (
    <table className="ports">
      <caption>Ports</caption>
      <tbody>
        {rows.map(([way, port]) => (
          <tr key={`${way} ${port}`}>
            <td className="dim">{way}</td>
            <th scope="row">
              {port}
              <span className="fine port-axes">{over(port)}</span>
            </th>
            <td>
              <Prose text={kind.ports[port] ?? ""} />
            </td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}
