// The folders below the root, and the files of one sort in them.

import { IconFileText, IconFolder, IconMovie, IconPhoto } from "@tabler/icons-react";
import { TextInput } from "@mantine/core";
import { useEffect, useRef, useState } from "react";

import { useStudio } from "../store";
import { ProblemText } from "../problems/ProblemText";
import { joined, rootName, steps } from "../files/paths";
import type { useFolder } from "./useFolder";
import classes from "./FolderBrowser.module.css";

type Props = {
  // The present folder and its content; from useFolder.
  path: string;
  listing: ReturnType<typeof useFolder>;
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

export function FolderBrowser({
  path,
  listing: { folder, problem },
  wants,
  endings,
  onFolder,
  onFile,
  marked,
  records = false,
  first = false,
}: Props) {
  const [typed, setTyped] = useState("");
  const matches = (name: string) => name.toLowerCase().includes(typed.trim().toLowerCase());
  const facts = (name: string) => factsText(folder?.facts[name]);
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
  const FileIcon = wants === "files" ? IconFileText : IconPhoto;
  const at = (name: string) => joined(folder?.path ?? path, name);
  const all = [...(folder?.files ?? []), ...(folder?.pictures ?? []), ...(folder?.others ?? [])];
  const names =
    endings !== undefined
      ? all.filter((name) => endings.some((ending) => name.toLowerCase().endsWith(ending)))
      : wants === "records"
        ? []
        : (folder?.[wants] ?? []);
  const runs = records ? [] : (folder?.records ?? []).filter((name) => !name.endsWith(".nc"));
  const folders = [...(folder?.folders ?? []), ...runs];
  const empty = folder !== null && folder.folders.length + folder.records.length + names.length === 0;
  return (
    <div className={classes.browser}>
      <nav className={classes.steps} aria-label="Folder">
        <button type="button" className={classes.step} title={root} onClick={() => onFolder("")}>
          {rootName(root)}
        </button>
        {steps(path).map((step) => (
          <span key={step.path}>
            <span className={classes.slash}>/</span>
            <button type="button" className={classes.step} onClick={() => onFolder(step.path)}>
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
        className={classes.list}
        aria-label="Content of the folder"
        tabIndex={-1}
        data-autofocus={first || undefined}
      >
        {folders.filter(matches).map((name) => (
          <li key={`${name}/`}>
            <button type="button" className={classes.entry} title={name} onClick={() => onFolder(at(name))}>
              <IconFolder size={17} stroke={1.6} aria-label="Folder" />
              <span className="one-line">{name}</span>
            </button>
          </li>
        ))}
        {records &&
          folder?.records.filter(matches).map((name) => (
            <li key={`${name} record`}>
              <button type="button" className={classes.entry} title={name} onClick={() => onFile(at(name))}>
                <IconMovie size={17} stroke={1.6} aria-label="Record" />
                <span className="one-line">{name}</span>
                <span className={classes.facts} aria-hidden>
                  {facts(name)}
                </span>
              </button>
            </li>
          ))}
        {names.filter(matches).map((name) => (
          <li key={name}>
            <button
              type="button"
              className={classes.entry}
              title={name}
              data-marked={at(name) === marked || undefined}
              onClick={() => onFile(at(name))}
            >
              <FileIcon size={17} stroke={1.6} aria-hidden="true" />
              <span className="one-line">{name}</span>
              <span className={classes.facts} aria-hidden>
                {facts(name)}
              </span>
            </button>
          </li>
        ))}
        {empty && (
          <li className={classes.empty}>
            {endings !== undefined
              ? `No files here that end in ${endings.join(", ")}`
              : wants === "pictures"
                ? "No pictures here"
                : wants === "records"
                  ? "No records here"
                  : records
                    ? "No documents (.json, .deodar) or records here"
                    : "No documents (.json, .deodar) here"}
          </li>
        )}
        {problem !== null && (
          <li className={classes.empty}>
            <ProblemText problem={problem} />
          </li>
        )}
      </ul>
    </div>
  );
}

// "12 kB, 29/11/2026", in the words of the browser; empty for a folder.
function factsText(facts: unknown[] | undefined): string {
  if (facts === undefined) {
    return "";
  }
  const [bytes, seconds] = facts as [number, number];
  const size =
    bytes < 1e3
      ? `${bytes} B`
      : bytes < 1e6
        ? `${Math.round(bytes / 1e3)} kB`
        : `${(bytes / 1e6).toFixed(1)} MB`;
  return `${size}, ${new Date(1000 * seconds).toLocaleDateString()}`;
}
