// The menu of all tools and of what the views have besides plots, which adds plots too.

import { ActionIcon, Menu, ScrollArea } from "@mantine/core";
import { IconChartLine, IconPlus } from "@tabler/icons-react";
import { useState } from "react";
import { showView } from "../state/page";
import { changePerson } from "../state/person";
import { openTool } from "../state/tool";
import { useStudio } from "../server/store";
import { openInThisView, restoreFrame } from "./author";
import { openPlot } from "../actions/openPlot";
import { TITLES } from "./titles";
import { TOOLS } from "./tools";

const PARTS = [
  { title: TITLES.graph, open: () => showView("build") },
  {
    title: TITLES.palette,
    open: () => {
      showView("build");
      changePerson({ palette: true });
    },
  },
  { title: TITLES.experiment, open: () => showView("experiment") },
  { title: TITLES.world, open: () => showView("robot") },
];
const MOST = 60;

/** What contains a search is no menu, which Mantine makes of it: the menu is the list below the search. */
function asGroup(dropdown: HTMLElement | null): void {
  dropdown?.setAttribute("role", "group");
  dropdown?.removeAttribute("aria-orientation");
}

export function PanelMenu() {
  const [search, setSearch] = useState("");
  const elements = useStudio((state) => state.document?.elements);
  const edited = useStudio((state) => state.document?.record == null);
  const wanted = search.trim().toLowerCase();
  const panels = [
    ...[...TOOLS].map(([name, { title }]) => ({ title, open: () => openTool(name) })),
    ...PARTS,
  ];
  const tools = panels.filter(({ title }) => title.toLowerCase().includes(wanted));
  const found = (elements ?? []).filter((element) => element.path.toLowerCase().includes(wanted));
  return (
    <Menu position="bottom-end" width={280} onClose={() => setSearch("")}>
      <Menu.Target>
        <ActionIcon size={28} aria-label="Open panels and plots" title="Open tools and plots">
          <IconPlus size={16} />
        </ActionIcon>
      </Menu.Target>
      <Menu.Dropdown ref={asGroup}>
        <Menu.Search
          size="xs"
          placeholder="Find a panel or an element"
          aria-label="Find a panel, or an element to plot"
          value={search}
          onChange={(event) => setSearch(event.currentTarget.value)}
        />
        <div role="menu" aria-label="Panels and plots">
          {tools.map(({ title, open }) => (
            <Menu.Item key={title} onClick={open}>
              {title}
            </Menu.Item>
          ))}
          {tools.length > 0 && <Menu.Divider />}
          <Menu.Label>Plot</Menu.Label>
          <ScrollArea.Autosize mah="clamp(90px, 100vh - 570px, 260px)" type="auto">
            {found.slice(0, MOST).map((element) => (
              <Menu.Item
                key={element.id}
                leftSection={<IconChartLine size={15} />}
                title={element.path}
                onClick={() => openPlot({ element: element.id })}
              >
                <span className="one-line">{element.path}</span>
              </Menu.Item>
            ))}
            {found.length > MOST && <Menu.Label>{found.length - MOST} more: type to find them</Menu.Label>}
            {found.length === 0 && <Menu.Label>No element has this name.</Menu.Label>}
          </ScrollArea.Autosize>
          {wanted === "" && (
            <>
              <Menu.Divider />
              <Menu.Label>View</Menu.Label>
              {edited && <Menu.Item onClick={openInThisView}>Open the document in this view</Menu.Item>}
              <Menu.Item onClick={restoreFrame}>Restore views, tools and plots</Menu.Item>
            </>
          )}
        </div>
      </Menu.Dropdown>
    </Menu>
  );
}
