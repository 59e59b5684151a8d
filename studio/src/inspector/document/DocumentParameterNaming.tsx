// The name of a new document parameter, asked for below the parameter that it will drive first.

import { Button, TextInput } from "@mantine/core";
import { useState, type FormEvent } from "react";

import type { ListedProblem } from "../../protocol";
import { socket } from "../../socket";
import { useLateFocus } from "../../widgets/lateFocus";
import { ProblemLine } from "../../widgets/ProblemLine";

type DocumentParameterNamingProps = { element: string; path: string; suggestion: string; onDone: () => void };

export function DocumentParameterNaming({ element, path, suggestion, onDone }: DocumentParameterNamingProps) {
  const field = useLateFocus();
  const [name, setName] = useState(suggestion);
  const [problem, setProblem] = useState<ListedProblem | null>(null);
  const onSubmit = async (event: FormEvent) => {
    event.preventDefault();
    const { answer } = await socket.ask({
      type: "add_document_parameter",
      name: name.trim(),
      element,
      parameter: path,
    });
    const wrong = answer.problems?.[0] ?? null;
    setProblem(wrong);
    if (wrong === null) {
      onDone();
    }
  };
  return (
    <form
      className="parameter-naming"
      onSubmit={(event) => void onSubmit(event)}
      onKeyDown={(event) => event.key === "Escape" && onDone()}
    >
      <TextInput
        size="xs"
        aria-label="Name of the document parameter"
        placeholder="name"
        value={name}
        error={problem !== null}
        ref={field}
        onFocus={(event) => event.currentTarget.select()}
        onChange={(event) => {
          setName(event.currentTarget.value);
          setProblem(null);
        }}
      />
      <Button size="compact-xs" type="submit" disabled={name.trim() === ""}>
        Create
      </Button>
      <Button size="compact-xs" variant="subtle" color="gray" onClick={onDone}>
        Cancel
      </Button>
      <ProblemLine problem={problem} />
    </form>
  );
}
