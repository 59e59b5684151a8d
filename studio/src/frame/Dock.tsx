// The tools, one at a time, in a column of a fixed width that a person may drag.

import { IconX } from "@tabler/icons-react";
import { Activity, type CSSProperties, type KeyboardEvent, type PointerEvent } from "react";
import { type RefObject, useRef, useState } from "react";
import { flushSync } from "react-dom";
import { NeedsServer } from "../widgets/NeedsServer";
import { dropParameter } from "../actions/pinDrag";
import { usePage } from "../state/page";
import { changePerson, usePerson } from "../state/person";
import { openTool } from "../state/tool";
import { useWidth } from "../widgets/useWidth";
import classes from "./Dock.module.css";
import { PanelMenu } from "./PanelMenu";
import { firstTool, isStanding, STANDING, TOOLS } from "./tools";

const WIDTH = { least: 280, most: 480, step: 10 };

export function Dock() {
  const view = usePage((page) => page.view);
  // One more shows a tool that was opened besides those that are always there.
  const extra =
    usePage((page) => page.opened.findLast((tool) => TOOLS.has(tool) && !isStanding(tool))) ?? null;
  const opened = usePage((page) => page.tabs[view]);
  const habit = usePerson((person) => person.tabs[view]);
  const isOpen = (tool: string | undefined) => tool !== undefined && (isStanding(tool) || tool === extra);
  const shown = [opened, habit].find(isOpen) ?? firstTool(view);
  const width = usePerson((person) => person.dock);
  const dock = useRef<HTMLElement>(null);
  const tabs = useRef<HTMLDivElement>(null);
  // A tool that another one hides keeps what was typed and scrolled in it.
  const [visited, setVisited] = useState<readonly string[]>([]);
  if (!visited.includes(shown)) {
    setVisited([...visited, shown]);
  }

  // What does not fit beside the others is in the menu.
  const last = STANDING.at(-1) ?? "";
  const tools = [...STANDING.slice(0, -1), extra === null || shown === last ? last : extra];
  const choose = (tool: string) => {
    openTool(tool);
    if (isStanding(tool)) {
      changePerson({ tabs: { ...usePerson.getState().tabs, [view]: tool } });
    }
  };
  const close = () => {
    flushSync(() => {
      usePage.setState({ opened: [] });
      setVisited(visited.filter((tool) => tool !== extra));
    });
    tabs.current?.querySelector<HTMLElement>('[aria-selected="true"]')?.focus();
  };
  const key = (event: KeyboardEvent, tool: string) => {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key] ?? 0;
    const next = tools[(tools.indexOf(tool) + step + tools.length) % tools.length];
    if (step !== 0 && next !== undefined) {
      event.preventDefault();
      choose(next);
      tabs.current?.querySelector<HTMLElement>(`[data-tool="${next}"]`)?.focus();
    } else if (event.key === "Delete" && tool === extra) {
      event.stopPropagation();
      close();
    }
  };
  const style = (width === 0 ? {} : { "--dock": `${width}px` }) as CSSProperties;
  return (
    <aside ref={dock} className={`down ${classes.dock}`} style={style} aria-label="Tools">
      <Edge dock={dock} />
      <div className={classes.head}>
        <div className={classes.tabs} role="tablist" aria-label="Tools" ref={tabs}>
          {tools.map((tool) => (
            <div
              key={tool}
              role="tab"
              data-tool={tool}
              id={`tab-${tool}`}
              aria-selected={tool === shown}
              aria-controls={tool === shown ? `tool-${tool}` : undefined}
              tabIndex={tool === shown ? 0 : -1}
              className={classes.tab}
              onClick={() => choose(tool)}
              onKeyDown={(event) => key(event, tool)}
              {...(tool === "pins" && dropParameter(() => tool !== shown && choose(tool)))}
            >
              <span className="one-line">{TOOLS.get(tool)?.title}</span>
              {/* A tab may not contain a button: screen readers do not reach it. */}
              {tool === extra && (
                <span
                  className={classes.close}
                  aria-hidden="true"
                  title="Close (Delete)"
                  onClick={(event) => {
                    event.stopPropagation();
                    close();
                  }}
                >
                  <IconX size={13} stroke={1.6} />
                </span>
              )}
            </div>
          ))}
        </div>
        <PanelMenu />
      </div>
      {visited.map((tool) => {
        const { title, component: Content } = TOOLS.get(tool) ?? {};
        return (
          <Activity key={tool} mode={tool === shown ? "visible" : "hidden"}>
            <div className={classes.tool} id={`tool-${tool}`} role="tabpanel" aria-label={title}>
              <NeedsServer>{Content !== undefined && <Content />}</NeedsServer>
            </div>
          </Activity>
        );
      })}
    </aside>
  );
}

// The border that sets the width of the dock.
function Edge({ dock }: { dock: RefObject<HTMLElement | null> }) {
  // As it is drawn, which depends on the window too.
  const width = useWidth(dock);
  const set = (wanted: number) =>
    changePerson({ dock: Math.round(Math.min(WIDTH.most, Math.max(WIDTH.least, wanted))) });
  const drag = (event: PointerEvent) => {
    if (event.currentTarget.hasPointerCapture(event.pointerId)) {
      set(innerWidth - event.clientX);
    }
  };
  const key = (event: KeyboardEvent) => {
    const step = { ArrowLeft: WIDTH.step, ArrowRight: -WIDTH.step }[event.key];
    if (step !== undefined) {
      event.preventDefault();
      set(width + step);
    }
  };
  return (
    <div
      className={classes.edge}
      role="separator"
      aria-label="Width of the tools"
      aria-orientation="vertical"
      aria-valuemin={WIDTH.least}
      aria-valuemax={WIDTH.most}
      aria-valuenow={width}
      tabIndex={0}
      title="Drag to change the width; double-click for the first one"
      onPointerDown={(event) => event.currentTarget.setPointerCapture(event.pointerId)}
      onPointerMove={drag}
      onDoubleClick={() => changePerson({ dock: 0 })}
      onKeyDown={key}
    />
  );
}
