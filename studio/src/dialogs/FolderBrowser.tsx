// The folders below the root, and the files of one sort in them.

import { IconFileText, IconFolder, IconMovie, IconPhoto } from "@tabler/icons-react";
import { TextInput } from "@mantine/core";
import { useEffect, useRef, useState } from "react";

import { useStudio } from "../server/store";
import { ProblemText } from "../widgets/ProblemText";
import { joined, rootName, steps } from "../model/paths";
import type { Folder, ListedProblem } from "../protocol";
import { socket } from "../server/socket";
import { hasWords } from "../model/values";
import classes from "./dialogs.module.css";

type Listing = { folder: Folder | null; problem: ListedProblem | null };

// What lies in a folder below the root.
export function useFolder(path: string): Listing {
  const [listing, setListing] = useState<Listing>({ folder: null, problem: null });
  useEffect(() => {
    let wanted = true;
    void socket.ask({ type: "list_folder", path }).then(({ answer, folder }) => {
      if (wanted) {
        setListing({ folder, problem: answer.problems?.[0] ?? null });
      }
    });
    return () => {
      wanted = false;
    };
  }, [path]);
  return listing;
}

type Props = {
  // The present folder and its content; from useFolder.
  path: string;
  listing: Listing;
  wants: "files" | "pictures" | "records";
  // Endings of the files that are shown in place of those.
  endings?: string[];
  onFolder: (path: string) => void;
  onFile: (path: string) => void;
  // A file that is marked, by its path.
  marked?: string;
  // Whether records can be chosen; otherwise the folder of a run is a folder.
  records?: boolean;
  // Whether the keyboard begins in the list.
  first?: boolean;
};

export function FolderBrowser(props: Props) {
  const { path, listing, wants, endings, onFolder, onFile, marked, records = false, first = false } = props;
  const { folder, problem } = listing;
  const [typed, setTyped] = useState("");
  const root = useStudio((state) => state.welcome?.root ?? "");
  const list = useRef<HTMLUListElement>(null);
  const before = useRef(path);
  useEffect(() => {
    // The button that led here was removed; the focus moves to the list.
    if (before.current !== path) {
      before.current = path;
      setTyped("");
      list.current?.focus();
    }
  }, [path]);
  const at = (name: string) => joined(folder?.path ?? path, name);
  const all = [...(folder?.files ?? []), ...(folder?.pictures ?? []), ...(folder?.others ?? [])];
  const names =
    endings !== undefined
      ? all.filter((name) => endings.some((ending) => name.toLowerCase().endsWith(ending)))
      : wants === "records"
        ? []
        : (folder?.[wants] ?? []);
  const runs = folder?.records ?? [];
  const folders = [...(folder?.folders ?? []), ...runs.filter((name) => !records && !name.endsWith(".nc"))];
  const empty = folder !== null && folder.folders.length + runs.length + names.length === 0;
  const entries = (shown: string[], Icon: typeof IconFolder, choose: typeof onFile, label?: string) =>
    shown
      .filter((name) => hasWords(name, typed))
      .map((name) => (
        <li key={`${name} ${label}`}>
          <button
            type="button"
            className="list-entry"
            title={name}
            data-marked={at(name) === marked || undefined}
            onClick={() => choose(at(name))}
          >
            <Icon size={17} stroke={1.6} aria-label={label} aria-hidden={label === undefined} />
            <span className="one-line">{name}</span>
            <span className={`dim ${classes.facts}`} aria-hidden>
              {factsText(folder?.facts[name])}
            </span>
          </button>
        </li>
      ));
  return (
    <div className={classes.browser}>
      <nav className={classes.steps} aria-label="Folder">
        {[{ name: rootName(root), path: "" }, ...steps(path)].map((step, i) => (
          <span key={step.path}>
            {i > 0 && <span className="dim">/</span>}
            <button
              type="button"
              className={`bare-button one-line ${classes.step}`}
              title={i === 0 ? root : undefined}
              onClick={() => onFolder(step.path)}
            >
              {step.name}
            </button>
          </span>
        ))}
      </nav>
      <TextInput
        size="xs"
        aria-label="Filter the content of the folder"
        placeholder="Filter"
        value={typed}
        onChange={(event) => setTyped(event.currentTarget.value)}
      />
      <ul
        ref={list}
        className={`bare-list ${classes.list}`}
        aria-label="Content of the folder"
        tabIndex={-1}
        data-autofocus={first || undefined}
      >
        {entries(folders, IconFolder, onFolder, "Folder")}
        {records && entries(runs, IconMovie, onFile, "Record")}
        {entries(names, wants === "files" ? IconFileText : IconPhoto, onFile)}
        {empty && <li className="dim list-entry">{emptyText(endings, wants, records)}</li>}
        {problem !== null && (
          <li className="list-entry">
            <ProblemText problem={problem} />
          </li>
        )}
      </ul>
    </div>
  );
}

function emptyText(endings: string[] | undefined, wants: Props["wants"], records: boolean): string {
  if (endings !== undefined) {
    return `No files here that end in ${endings.join(", ")}`;
  }
  const documents = `documents (.json, .deodar)${records ? " or records" : ""}`;
  return `No ${wants === "files" ? documents : wants} here`;
}

// "12 kB, 29/11/2026", in the words of the browser; empty for a folder.
function factsText(facts: unknown[] | undefined): string {
  if (facts === undefined) {
    return "";
  }
  const [bytes, seconds] = facts as [number, number];
  const [scale, unit] = bytes < 1e3 ? [1, "B"] : bytes < 1e6 ? [1e3, "kB"] : [1e6, "MB"];
  const size = (bytes / scale).toFixed(unit === "MB" ? 1 : 0);
  return `${size} ${unit}, ${new Date(1000 * seconds).toLocaleDateString()}`;
}
