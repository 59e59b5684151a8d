// A folder below the root, and a name for the document in it.

import { Button, Group, TextInput } from "@mantine/core";
import { type FormEvent, useState } from "react";

import { FolderBrowser, useFolder } from "./FolderBrowser";
import { CancelButton } from "./MessageDialogs";
import type { Asking } from "../state/questions";
import { joined, lastPart, nameProblem, parent, withEnding } from "../model/paths";

export function SaveAsDialog({ question, answer }: Asking<"save_as">) {
  const [path, setPath] = useState(parent(question.path));
  const [name, setName] = useState(() =>
    lastPart(question.path) === "" ? "" : withEnding(lastPart(question.path)),
  );
  const [tried, setTried] = useState(false);
  const listing = useFolder(path);
  const problem = nameProblem(name);
  const target = joined(path, withEnding(name));
  const there =
    problem === "" && target !== question.path && listing.folder?.files.includes(withEnding(name)) === true;
  const submit = (event: FormEvent) => {
    event.preventDefault();
    setTried(true);
    if (problem === "") {
      answer(target);
    }
  };
  return (
    <form onSubmit={submit}>
      <FolderBrowser
        path={path}
        listing={listing}
        wants="files"
        onFolder={setPath}
        marked={target}
        onFile={(file) => setName(lastPart(file))}
      />
      <TextInput
        label="Name"
        size="sm"
        mt="md"
        value={name}
        onChange={(event) => setName(event.currentTarget.value)}
        spellCheck={false}
        error={(tried || name.trim() !== "") && problem !== "" ? problem : undefined}
        data-autofocus
        autoFocus
        onFocus={(event) =>
          event.currentTarget.setSelectionRange(0, event.currentTarget.value.replace(/\.json$/i, "").length)
        }
        description={
          there ? "A file of this name is there; you will be asked." : "Everything is kept in one JSON file."
        }
      />
      <Group gap="xs" mt="md" justify="flex-end">
        <CancelButton cancel={() => answer(null)} />
        <Button type="submit">Save</Button>
      </Group>
    </form>
  );
}
