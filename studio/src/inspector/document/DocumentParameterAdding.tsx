// A new document parameter, or another parameter for one that is there: which number of which element it
// drives.

import { Button, Select, TextInput } from "@mantine/core";
import { useMemo, useState, type FormEvent } from "react";

import type { ListedProblem } from "../../protocol";
import { socket } from "../../socket";
import { useStudio } from "../../store";
import { useLateFocus } from "../../widgets/lateFocus";
import { driver, leavesOf } from "../parameters/leaf";
import { ProblemLine } from "../../widgets/ProblemLine";

// Lists longer than this have a search box.
const MOST_SHOWN = 60;

// Without `name` a new document parameter is made, and its name is asked for.
export function DocumentParameterAdding({ name, onDone }: { name?: string; onDone: () => void }) {
  const field = useLateFocus();
  const [typed, setTyped] = useState("");
  const [chosen, setChosen] = useState<string | null>(null);
  const [problem, setProblem] = useState<ListedProblem | null>(null);
  const options = useOptions();
  const onSubmit = async (event: FormEvent) => {
    event.preventDefault();
    const { element = "", path: parameter = "" } = options.find((option) => option.value === chosen) ?? {};
    const { answer } = await socket.ask(
      name === undefined
        ? { type: "add_document_parameter", name: typed.trim(), element, parameter }
        : { type: "link", name, element, parameter },
    );
    const wrong = answer.problems?.[0] ?? null;
    setProblem(wrong);
    if (wrong === null) {
      onDone();
    }
  };
  return (
    <form
      className="parameter-adding"
      onSubmit={(event) => void onSubmit(event)}
      onKeyDown={(event) => event.key === "Escape" && onDone()}
    >
      {name === undefined && (
        <TextInput
          size="xs"
          aria-label="Name of the document parameter"
          placeholder="name"
          ref={field}
          value={typed}
          onChange={(event) => setTyped(event.currentTarget.value)}
        />
      )}
      <Select
        ref={name === undefined ? undefined : field}
        size="xs"
        searchable
        limit={MOST_SHOWN}
        data={options}
        value={chosen}
        aria-label="Driven parameter"
        placeholder="what it drives"
        nothingFoundMessage="No such parameter"
        comboboxProps={{ shadow: "md" }}
        onChange={setChosen}
      />
      <div className="form-buttons">
        <Button
          size="compact-xs"
          type="submit"
          disabled={chosen === null || (name === undefined && typed.trim() === "")}
        >
          {name === undefined ? "Create" : "Link"}
        </Button>
        <Button size="compact-xs" variant="subtle" color="gray" onClick={onDone}>
          Cancel
        </Button>
      </div>
      <ProblemLine problem={problem} />
    </form>
  );
}

// Every number of every element that can be driven and is not yet.
function useOptions(): { value: string; label: string; element: string; path: string }[] {
  const document = useStudio((state) => state.document);
  const kinds = useStudio((state) => state.kinds);
  return useMemo(
    () =>
      (document?.elements ?? []).flatMap((element) =>
        leavesOf(kinds, element.kind, element.values)
          .filter(({ path }) => driver(document, element.id, path) === undefined)
          .map(({ path }) => ({
            value: `${element.id} ${path}`,
            label: `${element.path}.${path}`,
            element: element.id,
            path,
          })),
      ),
    [document, kinds],
  );
}
