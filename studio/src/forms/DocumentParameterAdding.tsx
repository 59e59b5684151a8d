// A new document parameter, or another parameter for one that is there: which number of which element it
// drives.

import { Select, TextInput } from "@mantine/core";
import { useMemo, useState } from "react";

import { refusalOf } from "../server/socket";
import { useStudio } from "../server/store";
import { useLateFocus } from "../widgets/lateFocus";
import { driver, leavesOf } from "../model/leaf";
import { SmallForm } from "./SmallForm";

// Lists longer than this have a search box.
const MOST_SHOWN = 60;

type ParameterNamingProps = { element: string; path: string; suggestion: string; onDone: () => void };

// The name of a new document parameter, asked for below the parameter that it will drive first.
export function DocumentParameterNaming({ element, path, suggestion, onDone }: ParameterNamingProps) {
  const field = useLateFocus();
  const [name, setName] = useState(suggestion);
  return (
    <SmallForm
      className="parameter-naming"
      submit="Create"
      ready={name.trim() !== ""}
      send={() => refusalOf({ type: "add_document_parameter", name: name.trim(), element, parameter: path })}
      onDone={onDone}
    >
      {(refused) => (
        <TextInput
          aria-label="Name of the document parameter"
          placeholder="name"
          value={name}
          error={refused}
          ref={field}
          onFocus={(event) => event.currentTarget.select()}
          onChange={(event) => setName(event.currentTarget.value)}
        />
      )}
    </SmallForm>
  );
}

// Without `name` a new document parameter is made, and its name is asked for.
export function DocumentParameterAdding({ name, onDone }: { name?: string; onDone: () => void }) {
  const field = useLateFocus();
  const [typed, setTyped] = useState("");
  const [chosen, setChosen] = useState<string | null>(null);
  const options = useOptions();
  const isNew = name === undefined;
  const { element = "", path: parameter = "" } = options.find((option) => option.value === chosen) ?? {};
  return (
    <SmallForm
      className="parameter-adding"
      submit={isNew ? "Create" : "Link"}
      ready={chosen !== null && (!isNew || typed.trim() !== "")}
      send={() =>
        refusalOf(
          isNew
            ? { type: "add_document_parameter", name: typed.trim(), element, parameter }
            : { type: "link", name, element, parameter },
        )
      }
      onDone={onDone}
    >
      {() => (
        <>
          {isNew && (
            <TextInput
              aria-label="Name of the document parameter"
              placeholder="name"
              ref={field}
              value={typed}
              onChange={(event) => setTyped(event.currentTarget.value)}
            />
          )}
          <Select
            ref={isNew ? undefined : field}
            searchable
            limit={MOST_SHOWN}
            data={options}
            value={chosen}
            aria-label="Driven parameter"
            placeholder="what it drives"
            nothingFoundMessage="No such parameter"
            onChange={setChosen}
          />
        </>
      )}
    </SmallForm>
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
