// What all plots have in common: a line with the element, the choices and the menu, and below it the drawing
// or a word why there is none.

import { ActionIcon, Menu, NativeSelect, Popover, Tooltip } from "@mantine/core";
import {
  IconAdjustmentsHorizontal,
  IconDots,
  IconFileDescription,
  IconPhotoDown,
  IconTableDown,
  IconVectorSpline,
} from "@tabler/icons-react";
import { type MouseEvent, type ReactNode, useState } from "react";
import { NeedsServer, useOffline } from "../widgets/NeedsServer";
import type { ElementView, ListedProblem, SaveFigure } from "../protocol";
import { request } from "../server/socket";
import { useAfterFields } from "../widgets/afterFields";
import { useStudio } from "../server/store";
import { MenuList } from "../widgets/MenuList";
import type { DrawingFormat } from "./export/exportDrawing";
import type { Table } from "../draw/table";
import { saveTable } from "../server/save";
import { type PlotKind, portAxes } from "../model/ports";
import { hasFigure, titleOf } from "./kinds/plots";
import { PlotParameters } from "./controls/PlotParameters";
import type { PlotParams, PlotSettings } from "../model/settings";
import type { Streaming } from "./useStreams";
import "./plots.css";

// What every kind of plot is given.
export type PlotProps = {
  element: ElementView;
  port: string;
  // The other ways this element can be shown.
  kinds: PlotKind[];
  settings: PlotSettings;
  visible: boolean;
  change: (params: Partial<PlotParams>) => void;
  set: (settings: Partial<PlotSettings>) => void;
};

type PlotFrameProps = PlotProps & {
  kind: PlotKind;
  // Ports to choose from, if the kind shows one at a time.
  ports?: string[];
  legend?: ReactNode;
  note?: string;
  // Below the name: the axes that are not drawn.
  strip?: ReactNode;
  controls?: ReactNode;
  streaming: Streaming;
  exportAs: (format: DrawingFormat) => void;
  // The values that are drawn.
  table: () => Table | null;
  children: ReactNode;
};

export function PlotFrame(props: PlotFrameProps) {
  const { element, port, kinds, kind, ports, legend, note, strip, controls, streaming, children } = props;
  const { change, exportAs, table } = props;
  const range = props.settings.range === null ? null : [...props.settings.range];
  const running = useStudio((state) => state.clock?.running ?? false);
  const record = useStudio((state) => state.document?.record != null);
  const packaged = useStudio((state) => state.welcome?.plots) ?? [];
  const document = useStudio((state) => state.document);
  const axes = document === null ? [] : (portAxes(document, element, port) ?? []);
  const [editing, setEditing] = useState(false);
  const afterFields = useAfterFields();
  const { lost, seen } = streaming;
  const off = useOffline();
  const onClick = (event: MouseEvent) => {
    if (!off && event.target instanceof Element && event.target.closest(".plot-axis") !== null) {
      setEditing(true);
    }
  };
  return (
    <section className="plot" aria-label={`${titleOf(kind, packaged)} of ${element.path}`}>
      <header className="plot-head">
        <div className="flow plot-what">
          <span className="plot-path one-line" title={element.path}>
            {element.path}
          </span>
          {legend === undefined && note === undefined && (
            <span className="plot-note dim">{titleOf(kind, packaged)}</span>
          )}
          {ports !== undefined && (
            <NativeSelect
              variant="unstyled"
              className="plot-port"
              disabled={off}
              aria-label={`Port of ${element.path}`}
              data={ports}
              value={port}
              onChange={(event) => change({ port: event.currentTarget.value })}
            />
          )}
          {note !== undefined && note !== "" && <span className="plot-note dim">{note}</span>}
          <div className="plot-legend">
            <NeedsServer>{legend}</NeedsServer>
          </div>
        </div>
        <NeedsServer>
          <PlotParameters
            element={element}
            kind={kind}
            axes={axes}
            opened={editing && !off}
            onOpened={setEditing}
          />
          {controls !== undefined && (
            <Popover position="bottom-end" width={260} trapFocus {...afterFields}>
              <Popover.Target>
                <Tooltip label="Settings of this plot">
                  <ActionIcon size="sm" aria-label="Settings of this plot">
                    <IconAdjustmentsHorizontal size={15} />
                  </ActionIcon>
                </Tooltip>
              </Popover.Target>
              <Popover.Dropdown className="plot-controls">{controls}</Popover.Dropdown>
            </Popover>
          )}
        </NeedsServer>
        <Menu position="bottom-end" withinPortal>
          <Menu.Target>
            <ActionIcon size="sm" aria-label="Menu of this plot">
              <IconDots size={15} />
            </ActionIcon>
          </Menu.Target>
          <MenuList>
            {kinds.length > 1 && <Menu.Label>Show as</Menu.Label>}
            {kinds.length > 1 &&
              kinds.map((other) => (
                <Menu.Item
                  key={other}
                  disabled={off || other === kind}
                  onClick={() => change({ kind: other })}
                >
                  {titleOf(other, packaged)}
                </Menu.Item>
              ))}
            {kinds.length > 1 && <Menu.Divider />}
            {(["png", "svg"] as const).map((format) => (
              <Menu.Item
                key={format}
                leftSection={format === "png" ? <IconPhotoDown size={15} /> : <IconVectorSpline size={15} />}
                disabled={!seen}
                onClick={() => exportAs(format)}
              >
                Export {format.toUpperCase()}
              </Menu.Item>
            ))}
            <Menu.Item
              leftSection={<IconTableDown size={15} />}
              disabled={!seen}
              onClick={() => {
                const values = table();
                if (values !== null) {
                  saveTable(`${element.path} ${titleOf(kind, packaged)}`, values);
                }
              }}
            >
              Export CSV
            </Menu.Item>
            {hasFigure(kind, axes.length) && (
              <Menu.Item
                leftSection={<IconFileDescription size={15} />}
                disabled={off}
                onClick={() => void saveFigure({ element: element.id, port, kind, range })}
              >
                Save as a figure file
              </Menu.Item>
            )}
          </MenuList>
        </Menu>
      </header>
      <NeedsServer>{strip}</NeedsServer>
      <div className="plot-body" role="presentation" onClick={onClick}>
        {children}
        {!seen && (
          <div className="plot-message" role="status">
            {lost === null ? (
              <span>
                {record
                  ? "Reading the record"
                  : running
                    ? "Waiting for the first values"
                    : "Press play to see values"}
              </span>
            ) : (
              <>
                <strong>{record ? named(lost) : lost.what}</strong>
                {lost.fix !== undefined && lost.fix !== "" && <span>{lost.fix}</span>}
              </>
            )}
          </div>
        )}
        {seen && lost !== null && (
          <div className="plot-lost" role="status">
            {record ? named(lost) : lost.what}
          </div>
        )}
      </div>
    </section>
  );
}

// Writes the plot as a file that `deodar plot` draws.
async function saveFigure(plot: Omit<SaveFigure, "type">): Promise<void> {
  const answer = await request({ type: "save_figure", ...plot });
  if ((answer.problems ?? []).length === 0) {
    const what = `Saved as ${answer.file}. Type: deodar plot ${answer.file} --out figure.pdf`;
    useStudio.getState().notify({ what }, "info");
  }
}

// In a record, the port that has no frames, and why.
function named({ where = "", what }: ListedProblem): string {
  return `${where} ${what}`.trim();
}
