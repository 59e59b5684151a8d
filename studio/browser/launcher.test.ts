/** The studio opens a launcher of cosivina: its sliders are pinned, and its buttons and menus are presets. */
import { afterAll, beforeAll, expect, test } from "vitest";

import { obstacles } from "./axe";
import { button, choose, openTool, panel, slider } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

const LAUNCHER = `% a field that chooses between two cues
n = 80;
sim = Simulator();
sim.addElement(GaussStimulus1D('cue 1', n, 4, 0, 20, true, false));
sim.addElement(GaussStimulus1D('cue 2', n, 4, 0, 60, true, false));
sim.addElement(NeuralField('choice', n, 20, -5, 4), {'cue 1', 'cue 2'});
sim.addElement(LateralInteractions1D('choice -> choice', n, 4, 12, 9, 8, -0.2), ...
  'choice', [], 'choice');
gui = StandardGUI(sim, [50, 50, 700, 500]);
gui.addVisualization(MultiPlot({'cue 2', 'cue 1'}, {'output', 'output'}, [1, 1], 'horizontal'), [1, 1]);
gui.addVisualization(MultiPlot({'choice', 'choice'}, {'output', 'activation'}, [10, 1]), [2, 1]);
gui.addControl(ParameterSlider('rest', 'choice', 'h', [-10, 0], '%0.1f', 1, 'resting level'), [1, 1]);
gui.addControl(ParameterSlider('global', 'choice -> choice', 'amplitudeGlobal', [0, 2], '%0.2f', -1), [2, 1]);
gui.addControl(ParameterSwitchButton('cues', {'cue 1', 'cue 2'}, {'amplitude', 'amplitude'}, ...
  [0, 0], [7, 6], 'show both'), [3, 1]);
gui.addControl(ParameterDropdownSelector('distance', 'cue 2', 'position', [60, 40, 25], ...
  {'far', 'middle', 'near'}, 1), [4, 1]);
gui.run(inf);
`;

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio({ files: { "launcherChoice.m": LAUNCHER } });
  observer = await studio.observe();
});

afterAll(() => studio.stop());

const presets = () => panel(studio.page, "Sliders").getByRole("region", { name: "Presets of the document" });

test("a launcher opens by its name, with its sliders in their ranges", async () => {
  const { page } = studio;
  await button(page, "Open a file").click();
  await page
    .getByRole("dialog", { name: "Open a file" })
    .getByRole("button", { name: "launcherChoice.m" })
    .click();
  await observer.until(() => observer.document?.elements.length === 4);
  await button(page, "Dismiss").click(); // the offer to show the report
  for (const shown of ["Curves of cue 2", "Curves of choice"]) {
    await page.getByRole("region", { name: shown, exact: true }).waitFor({ state: "attached" });
  }
  await openTool(page, "Sliders");
  const rest = slider(page, "rest", "Sliders");
  await rest.waitFor();
  expect([await rest.getAttribute("aria-valuemin"), await rest.getAttribute("aria-valuemax")]).toEqual([
    "-10",
    "0",
  ]);
  await rest.focus();
  await rest.press("End");
  await observer.until(() => observer.value("choice", "resting_level") === 0);
  const global = slider(page, "global", "Sliders");
  await global.focus();
  await global.press("End");
  await observer.until(() => observer.value("choice -> choice", "global_inhibition") === 2);
});

test("its buttons and menus are presets, which a click applies as one step of undo", async () => {
  const { page } = studio;
  await presets().getByRole("button", { name: "Apply cues: on" }).click();
  await observer.until(() => observer.value("cue 1", "amplitude") === 7);
  expect(observer.value("cue 2", "amplitude")).toBe(6);
  await presets().getByRole("button", { name: "Apply distance: near" }).click();
  await observer.until(() => (observer.value("cue 2", "center") as number[])[0] === 25);
  await shot(page, "launcher");
  expect(await obstacles(page)).toEqual([]);
  await page.keyboard.press("Control+z");
  await observer.until(() => (observer.value("cue 2", "center") as number[])[0] === 60);
  expect(observer.value("cue 2", "amplitude")).toBe(6);
});

test("they are in the menu of presets, and can be removed", async () => {
  const { page } = studio;
  await button(page, "Snapshots and presets").click();
  const list = page.getByRole("dialog");
  await list.getByRole("button", { name: "Apply cues: off" }).click();
  await observer.until(() => observer.value("cue 1", "amplitude") === 0);
  await page.keyboard.press("Escape");
  await choose(page, "More for the presets cues", "Remove these presets");
  await presets().getByRole("button", { name: "Apply cues: off" }).waitFor({ state: "detached" });
  expect(
    await presets()
      .getByRole("button", { name: /^Apply/ })
      .count(),
  ).toBe(3);
});
