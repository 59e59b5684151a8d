import { execFileSync } from "node:child_process";
import { afterAll, beforeAll, expect, test } from "vitest";

import { button, panel } from "./hands";
import { python } from "./server";
import { shot, startStudio, type Studio } from "./studio";

// The experiment of the manual, with few trials; Python writes it.
const SCRIPT = `
import deodar as dd

x = dd.Axis("x", 0, 100, samples=101)
model = dd.Model("two targets")
kernel = [dd.Gaussian(1.2, 5)]
field = dd.Field("u", [x], tau=20, resting_level=-5, kernel=kernel, global_inhibition=0.6, noise=1.0)
u = model.add(field)
for name in ("left", "right"):
    model.add(dd.GaussianStimulus(name, [x], sigma=5, amplitude=5, windows=[(100, 600)])) >> u
model.add(dd.GaussianStimulus("preshape", [x], sigma=5, amplitude=1)) >> u
near = {"left.center": 46, "right.center": 54, "preshape.center": 46}
far = {"left.center": 35, "right.center": 65, "preshape.center": 35}
dd.Experiment(
    "two targets",
    model,
    limit=600,
    trials=25,
    conditions=[dd.Appears("detected", "u")],
    factors=[
        dd.Factor("distance", {"near": near, "far": far}),
        dd.Factor("preshape", [0.0, 1.0], "preshape.amplitude"),
    ],
    measures=[dd.Measure("place", "u.activation", "place", threshold=-2.5)],
).save("two-targets.json")
`;

let studio: Studio;

beforeAll(async () => {
  studio = await startStudio();
  execFileSync(python(), ["-c", SCRIPT], { cwd: studio.folder, stdio: "pipe" });
});

afterAll(() => studio.stop());

const shown = () => panel(studio.page, "Experiment");
const status = (text: RegExp) =>
  expect.poll(() => shown().getByRole("status").innerText(), { timeout: 120_000 }).toMatch(text);

async function open(name: string): Promise<void> {
  const { page } = studio;
  await page.keyboard.press("Control+o");
  const dialog = page.getByRole("dialog");
  await dialog.getByRole("button", { name, exact: true }).click();
  await dialog.waitFor({ state: "detached" });
}

test("an experiment opens from the list of files, runs, and shows each condition", async () => {
  const { page } = studio;
  await open("two-targets.json");
  await shown().getByRole("region", { name: "Appears detected" }).waitFor();
  await status(/^100 trials$/);
  await shot(page, "experiment-design");
  await button(page, "Run the experiment").click();
  await status(/^100 of 100 trials, complete$/);
  const bars = shown().getByRole("figure", { name: "place in each condition" });
  expect(await bars.getByRole("img").count()).toBe(4);
  const near = bars.getByRole("img", {
    name: /^distance near, preshape 1: median 4\d(\.\d+)? of 25 trials$/,
  });
  await near.waitFor();
  await shot(page, "experiment-results");
});

test("a row opens the record of its trial, and the model comes back", async () => {
  const { page } = studio;
  await shown().getByRole("button", { name: "Replay trial 63" }).click();
  await page.getByRole("toolbar", { name: "Record" }).waitFor({ timeout: 120_000 });
  await shown().getByText("Trial 63 is open as a record.").waitFor();
  const row = shown().getByRole("row", { selected: true });
  expect((await row.innerText()).split(/\s+/)[0]).toBe("63");
  await shot(page, "experiment-trial");
  await shown().getByRole("button", { name: "Back to the model" }).click();
  await page.getByRole("toolbar", { name: "Run", exact: true }).waitFor();
  await shown().getByRole("row", { selected: true }).waitFor({ state: "detached" });
});
