// A file below the root, or one of the person's own.

import { Button, FileButton, Group, Text } from "@mantine/core";
import { useState } from "react";

import { useStudio } from "../server/store";
import { FolderBrowser, useFolder } from "./FolderBrowser";
import { CancelButton } from "./MessageDialogs";
import type { Asking } from "../state/questions";
import { parent } from "../model/paths";

const ACCEPTED = {
  files: "application/json,.json,.deodar,.dnf,.m",
  pictures: "image/*",
  values: "application/json,.json",
  records: "",
  experiments: "",
};

export function ChooseDialog({ question: { wants }, answer }: Asking<"choose">) {
  const file = useStudio((state) => state.document?.record?.path ?? state.document?.file ?? "");
  const [path, setPath] = useState(parent(file));
  const listing = useFolder(path);
  return (
    <>
      {wants === "values" && (
        <Text size="sm" mb="sm">
          Elements of the same name and kind take the values that they have in the file. Connections stay, and
          undo takes all of it back.
        </Text>
      )}
      <FolderBrowser
        path={path}
        listing={listing}
        wants={wants === "pictures" || wants === "records" ? wants : "files"}
        onFolder={setPath}
        onFile={answer}
        records={wants === "files" || wants === "records"}
        marked={file}
        first
      />
      <Group gap="xs" mt="md" justify="space-between">
        {wants === "records" || wants === "experiments" ? (
          <span />
        ) : (
          <FileButton accept={ACCEPTED[wants]} onChange={(chosen) => chosen !== null && answer(chosen)}>
            {(props) => (
              <Button variant="default" {...props}>
                From elsewhere on this computer…
              </Button>
            )}
          </FileButton>
        )}
        <CancelButton cancel={() => answer(null)} />
      </Group>
    </>
  );
}
