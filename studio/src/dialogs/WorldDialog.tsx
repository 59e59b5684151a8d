// Chooses the world of the sensors and motors: its kind, what it is made from, and what it looks like.

import "../world/world.css";

import { Button, Checkbox, FileButton, Group, NativeSelect, TextInput } from "@mantine/core";
import { useEffect, useRef, useState } from "react";

import { FolderBrowser, useFolder } from "./FolderBrowser";
import { ProblemText } from "../widgets/ProblemText";
import type { Asking } from "../state/questions";
import { base64, isTooLarge } from "../files/flows";
import { lastPart } from "../model/paths";
import { pageInk } from "../widgets/look";
import { paintBytes } from "../draw/paint";
import type { Answer, Kind, ListedProblem, MotorLimits, WorldPreview, WorldSettingView } from "../protocol";
import { socket } from "../server/socket";
import { useStudio } from "../server/store";
import { NumberField } from "../widgets/NumberField";
import { bytesOf } from "../model/base64";
import { draw } from "../world/draw";
import { NOTHING_SEEN } from "../server/live";
import { NarrowMotors } from "../world/NarrowMotors";
import { frameOf } from "../world/planFrame";

type SettingValues = Record<string, unknown>;

export function WorldDialog({ answer }: Asking<"world">) {
  const kinds = useStudio((state) => state.kinds);
  const used = useStudio((state) => state.clock?.world ?? "");
  const worlds = [...kinds.values()].filter((kind) => kind.room === "worlds" && kind.settings.length > 0);
  const [name, setName] = useState(() => {
    const now = worlds.find((kind) => used.startsWith(`${kind.name}:`)) ?? worlds[0];
    return now?.name ?? "";
  });
  const kind = kinds.get(name);
  return (
    <>
      <NativeSelect
        label="Kind of world"
        value={name}
        data={worlds.map((one) => ({ value: one.name, label: one.title }))}
        onChange={(event) => setName(event.currentTarget.value)}
        data-autofocus
      />
      {kind !== undefined && <WorldForm key={name} kind={kind} done={() => answer(null)} />}
    </>
  );
}

function WorldForm({ kind, done }: { kind: Kind; done: () => void }) {
  const [first, ...others] = kind.settings;
  const [argument, setArgument] = useState<string | File>(String(first?.default ?? ""));
  const [values, setValues] = useState<SettingValues>({});
  const [problems, setProblems] = useState<ListedProblem[]>([]);
  const [preview, setPreview] = useState<WorldPreview | null>(null);
  const [limits, setLimits] = useState<Record<string, MotorLimits>>({});
  const take = (found: Answer) => {
    setProblems(found.problems ?? []);
    return (found.problems ?? []).length === 0;
  };
  const path = typeof argument === "string" ? argument : "";

  // What the world looks like, some time after the last change.
  useEffect(() => {
    setPreview(null);
    setLimits({});
    if (path === "") {
      return;
    }
    let old = false;
    const timer = setTimeout(async () => {
      const found = (await socket.ask({ type: "preview_world", kind: kind.name, path, settings: values }))
        .answer;
      if (!old && take(found)) {
        setPreview(found.preview ?? null);
      }
    }, PREVIEW_AFTER_MS);
    return () => {
      old = true;
      clearTimeout(timer);
    };
  }, [kind.name, path, values]);

  const use = async () => {
    const settings = values;
    const { answer } =
      typeof argument === "string"
        ? await socket.ask({
            type: "use_world",
            kind: kind.name,
            path: argument,
            settings,
            limits: Object.values(limits),
          })
        : await socket.ask({
            type: "use_world_content",
            kind: kind.name,
            name: argument.name,
            content: await base64(argument),
            settings,
          });
    if (take(answer)) {
      done();
    }
  };
  const missing = preview?.missing ?? [];
  return (
    <div className="world-form">
      {first !== undefined && <Source kind={kind} setting={first} argument={argument} choose={setArgument} />}
      {others.length > 0 && (
        <details className="world-settings">
          <summary>Settings</summary>
          {others.map((setting) => (
            <SettingInput
              key={setting.name}
              setting={setting}
              value={values[setting.name]}
              set={(value) =>
                setValues(({ [setting.name]: _, ...rest }) =>
                  value === undefined ? rest : { ...rest, [setting.name]: value },
                )
              }
            />
          ))}
        </details>
      )}
      {preview !== null && <Preview preview={preview} />}
      {preview !== null && preview.limits.length > 0 && (
        <fieldset className="world-limits">
          <legend>The robot stays within these limits</legend>
          <NarrowMotors
            motors={preview.limits}
            set={(typed) => setLimits((before) => ({ ...before, [typed.motor]: typed }))}
          />
        </fieldset>
      )}
      {missing.length > 0 && (
        <p className="world-missing" role="status">
          This world has no {missing.join(", ")}, which the model needs.
        </p>
      )}
      {problems.map((problem, i) => (
        <ProblemText key={i} problem={problem} />
      ))}
      <Group gap="xs" mt="md" justify="flex-end">
        <Button variant="subtle" color="gray" onClick={done}>
          Cancel
        </Button>
        <Button disabled={argument === "" || missing.length > 0} onClick={() => void use()}>
          Use this world
        </Button>
      </Group>
    </div>
  );
}

const PREVIEW_AFTER_MS = 300;

type SourceProps = {
  kind: Kind;
  setting: WorldSettingView;
  argument: string | File;
  choose: (argument: string | File) => void;
};

// The file, or the name, or the number that the world is opened with.
function Source({ kind, setting, argument, choose }: SourceProps) {
  const [folder, setFolder] = useState("");
  const listing = useFolder(folder);
  const shown = typeof argument === "string" ? argument : argument.name;
  if (setting.form !== "file") {
    return (
      <TextInput
        label={setting.name}
        description={setting.meaning}
        value={shown}
        onChange={(event) => choose(event.currentTarget.value)}
      />
    );
  }
  const records = kind.opens.includes(".zarr");
  return (
    <>
      {kind.names.length > 0 && (
        <NativeSelect
          label={setting.name}
          value={kind.names.includes(shown) ? shown : ""}
          data={[{ value: "", label: "a file" }, ...kind.names]}
          onChange={(event) => choose(event.currentTarget.value)}
        />
      )}
      {!kind.names.includes(shown) && (
        <>
          <p className="world-file one-line">{shown === "" ? "Choose a file:" : lastPart(shown)}</p>
          <FolderBrowser
            path={folder}
            listing={listing}
            wants={records ? "records" : "files"}
            endings={records ? undefined : kind.opens}
            records={records}
            onFolder={setFolder}
            onFile={choose}
            marked={shown}
          />
          {!records && (
            <FileButton
              accept={kind.opens.join()}
              onChange={(file) => file !== null && !isTooLarge(file) && choose(file)}
            >
              {(props) => (
                <Button variant="default" size="compact-sm" mt={6} {...props}>
                  From elsewhere on this computer…
                </Button>
              )}
            </FileButton>
          )}
        </>
      )}
    </>
  );
}

type SettingInputProps = { setting: WorldSettingView; value: unknown; set: (value: unknown) => void };

// One setting; `undefined` is its default.
function SettingInput({ setting, value, set }: SettingInputProps) {
  const { name, form, meaning } = setting;
  const common = { label: name, description: meaning, size: "xs", mt: 6 } as const;
  const standard = setting.default;
  if (form === "flag") {
    return (
      <Checkbox
        {...common}
        defaultChecked={standard === true}
        onChange={(event) => set(event.currentTarget.checked)}
      />
    );
  }
  if (form === "number") {
    return (
      <NumberField
        label={name}
        description={meaning}
        value={(value ?? standard) as number | null}
        set={set}
        clear={() => set(undefined)}
      />
    );
  }
  const numbers = form === "numbers";
  return (
    <TextInput
      {...common}
      defaultValue={numbers ? "" : String(standard ?? "")}
      placeholder={numbers ? "numbers with spaces between; empty: the default" : undefined}
      onChange={(event) => set(numbers ? numbersOf(event.currentTarget.value) : event.currentTarget.value)}
    />
  );
}

function numbersOf(text: string): number[] | undefined {
  const found = text
    .trim()
    .split(/[\s,]+/)
    .filter(Boolean)
    .map(Number);
  return found.length > 0 && found.every(Number.isFinite) ? found : undefined;
}

function Preview({ preview }: { preview: WorldPreview }) {
  const { scene, width, height, pixels, sensors, motors } = preview;
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const ctx = canvas.current?.getContext("2d");
    if (canvas.current === null || ctx == null) {
      return;
    }
    if (scene !== null) {
      const [w, h] = [canvas.current.clientWidth, 220];
      Object.assign(canvas.current, { width: w * devicePixelRatio, height: h * devicePixelRatio });
      ctx.scale(devicePixelRatio, devicePixelRatio);
      const seen = { ...NOTHING_SEEN, scene };
      draw(ctx, frameOf(scene.border, w, h), seen, { hovered: null, selected: null, held: null }, pageInk());
    } else if (width > 0) {
      paintBytes(canvas.current, bytesOf(pixels), width, height);
    }
  }, [preview]);
  return (
    <figure className="world-preview">
      {(scene !== null || width > 0) && (
        <canvas ref={canvas} role="img" aria-label="Preview of the world" data-scene={scene !== null} />
      )}
      <figcaption className="dim">
        Sensors: {sensors.join(", ") || "none"}
        {motors.length > 0 && `; motors: ${motors.join(", ")}`}
      </figcaption>
    </figure>
  );
}
