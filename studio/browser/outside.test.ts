import { expect, onTestFinished, test } from "vitest";

import { button, colours, drag, number, panel, select, slider, type } from "./hands";
import { shot, startStudio } from "./studio";

/** An element that a user writes because deodar does not have it. */
const MODULE = `
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

from deodar.element import Arrays, Element, Setting
from deodar.numerics.axes import Axes, Axis
from deodar.numerics.integrators import euler
from deodar.parameters import Live
from deodar.registry import register


@register
@dataclass(frozen=True)
class LeakyCounter(Element):
    r"""Counts what comes in, and forgets it.

    Equation:
        \\tau \\frac{dz}{dt} = -z + \\mathrm{rate} + \\mathrm{input}

    Parameters:
        axes: where it is defined; none: one number.
        tau: time constant; in the document's time unit, > 0.
        rate: what it counts without input.
        alarm: a level to compare the count with.

    Ports:
        input: over \`axes\`.
        count: z, over \`axes\`.
    """

    name: str = ""
    axes: Sequence[Axis] = ()
    tau: Annotated[float, Live("time", role="time constant", lower=1e-6)] = 50.0
    rate: Annotated[float, Live("activation", lower=0, upper=20)] = 2.0
    alarm: Annotated[float, Live("activation")] = 4.0

    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {}
    levels: ClassVar[Mapping[str, Mapping[str, str]]] = {"count": {"alarm": "alarm"}}

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"count": tuple(self.axes)}

    def init(self, at: Setting) -> Arrays:
        return {"z": at.full(tuple(self.axes), 0.0)}

    def output(self, at: Setting) -> Arrays:
        return {"count": at.state["z"]}

    def advance(self, at: Setting) -> Arrays:
        z = at.state["z"]
        return {"z": euler(z, -z + self.rate + at.inputs["input"], self.tau, at.time.dt)}
`;

const DOCUMENT = {
  deodar: 1,
  name: "counting",
  time_unit: "ms",
  axes: { x: { name: "x", lower: 0, upper: 10, samples: 21, unit: "deg" } },
  elements: {
    bump: { kind: "GaussianStimulus", id: "00000001", axes: ["x"], center: 5, sigma: 1, amplitude: 3 },
    counter: { kind: "LeakyCounter", id: "00000002", axes: ["x"] },
  },
  connections: [{ source: "bump.output", target: "counter.input" }],
};

test("an element of a user runs and has a form, an equation, a live picture and a plot", async () => {
  const files = { "counters.py": MODULE, "counting.json": JSON.stringify(DOCUMENT) };
  const { page, observe, stop } = await startStudio({ files, file: "counting.json", imports: ["counters"] });
  onTestFinished(stop);
  const observer = await observe();
  await observer.runs();

  await select(page, "counter");
  const inspector = panel(page, "Inspector");
  await inspector.getByText("Leaky counter", { exact: true }).waitFor();
  await inspector.getByRole("region", { name: "Equation" }).locator(".katex").first().waitFor();
  expect(
    await inspector.getByRole("region", { name: "Equation" }).getByRole("math").first().textContent(),
  ).toContain("τ");
  expect(await inspector.getByRole("group", { name: "tau", exact: true }).innerText()).toContain("ms");
  const rate = slider(page, "rate");
  expect([await rate.getAttribute("aria-valuemin"), await rate.getAttribute("aria-valuemax")]).toEqual([
    "0",
    "20",
  ]);
  expect(await number(page, "alarm").inputValue()).toBe("4");
  await inspector.getByRole("table", { name: "Ports" }).getByText("z, over axes.").waitFor();

  const plot = page.getByRole("region", { name: "Curves of counter" });
  await plot.waitFor();
  await plot.getByRole("button", { name: "levels" }).waitFor();
  await button(page, "Play").click();
  await observer.until(() => observer.max("counter", "count") > 4.5);
  await plot.getByText("Press play").waitFor({ state: "detached" });
  await expect.poll(() => colours(plot.getByRole("img", { name: /^count of counter/ }))).toBeGreaterThan(5);
  await expect
    .poll(() => colours(page.getByRole("img", { name: "count of counter, live" })))
    .toBeGreaterThan(2);

  await drag(page, rate, 0.5);
  await observer.until(() => Math.abs(Number(observer.value("counter", "rate")) - 10) < 1);
  await observer.until(() => observer.max("counter", "count") > 12.5);
  await shot(page, "outside");
  await type(page, "tau", "-5");
  await inspector.getByText("below its lower bound").waitFor();
});
