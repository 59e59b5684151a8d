// The presets of a document as buttons, in a row for each menu or switch that they belong to.

import { Button, Menu } from "@mantine/core";
import { IconTrash } from "@tabler/icons-react";

import { applyKeptPreset } from "../files/presets";
import { useStudio } from "../server/store";
import { DotsMenu } from "../widgets/DotsMenu";
import { choiceText, type PresetGroup, presetGroups, removeGroup } from "./presetGroups";

export function KeptPresets() {
  const presets = useStudio((state) => state.document?.layout.presets);
  const groups = presetGroups(presets ?? []);
  if (groups.length === 0) {
    return null;
  }
  return (
    <section className="kept-presets" aria-label="Presets of the document">
      {groups.map((group) => (
        <PresetRow key={group.group} {...group} />
      ))}
    </section>
  );
}

function PresetRow({ group, presets }: PresetGroup) {
  const title = group === "" ? "Presets" : group;
  return (
    <fieldset className="preset-group">
      <legend className="preset-title">
        <span className="one-line">{title}</span>
        <DotsMenu label={`More for the presets ${title}`}>
          <Menu.Item leftSection={<IconTrash size={14} />} onClick={() => removeGroup(group)}>
            Remove these presets
          </Menu.Item>
        </DotsMenu>
      </legend>
      {presets.map((preset) => (
        <Button
          key={preset.name}
          size="compact-xs"
          variant="default"
          aria-label={`Apply ${preset.name}`}
          onClick={() => void applyKeptPreset(preset.name)}
        >
          {choiceText(preset)}
        </Button>
      ))}
    </fieldset>
  );
}
