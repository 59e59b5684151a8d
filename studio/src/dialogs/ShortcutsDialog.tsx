// The keys of the page, and the actions of the mouse in the panels.

import { Kbd } from "@mantine/core";
import { Fragment } from "react";

import { keysText } from "../model/keys";
import { SHORTCUTS } from "../commands/shortcuts";
import classes from "./dialogs.module.css";

type Line = { keys: readonly string[]; does: string };

const ELSEWHERE: Record<string, readonly Line[]> = {
  "In the architecture": [
    { keys: ["Ctrl+F"], does: "Search" },
    { keys: ["Double click", "on the ground"], does: "Add an element there (also the right button)" },
    { keys: ["Double click"], does: "Plot an element" },
  ],
  "In a plot of a field": [
    { keys: ["Right button"], does: "Add input while it is held" },
    { keys: ["Shift", "Right button"], does: "Boost the whole field" },
    { keys: ["I"], does: "Add input with the keyboard" },
  ],
};

export function ShortcutsDialog() {
  return (
    <div className={classes.columns}>
      <Lines title="Everywhere" lines={SHORTCUTS} together=" or " />
      <div>
        {Object.entries(ELSEWHERE).map(([title, lines]) => (
          <Lines key={title} title={title} lines={lines} together=" " />
        ))}
      </div>
    </div>
  );
}

function Lines({ title, lines, together }: { title: string; lines: readonly Line[]; together: string }) {
  return (
    <section>
      <h3>{title}</h3>
      <dl>
        {lines.map(({ keys, does }) => (
          <div key={does} className={`across ${classes.line}`}>
            <dt>{does}</dt>
            <dd>
              {keys.map((key, i) => (
                <Fragment key={key}>
                  {i > 0 && together}
                  <Kbd size="xs">{keysText(key)}</Kbd>
                </Fragment>
              ))}
            </dd>
          </div>
        ))}
      </dl>
    </section>
  );
}
