"""Write `two-targets.json`: the experiment of the manual, with few trials."""

import deodar as dd

x = dd.Axis("x", 0, 100, samples=101)
model = dd.Model("two targets")
kernel = [dd.Gaussian(1.2, 5)]
field = dd.Field("u", [x], tau=20, resting_level=-5, kernel=kernel, global_inhibition=0.6, noise=1.0)
u = model.add(field)
for name in ("left", "right"):
    model.add(dd.GaussianStimulus(name, [x], sigma=5, amplitude=5, windows=[dd.Window(100, 600)])) >> u
model.add(dd.GaussianStimulus("preshape", [x], sigma=5, amplitude=1)) >> u
near = {"left.center": 46, "right.center": 54, "preshape.center": 46}
far = {"left.center": 35, "right.center": 65, "preshape.center": 35}
place = dd.Measure("place", "u.activation", "place", threshold=-2.5)
dd.Experiment(
    "two targets",
    model,
    dd.TrialPlan(600, events=[dd.Appears("detected", "u")], measures=[place]),
    trials=25,
    factors=[
        dd.Factor("distance", {"near": near, "far": far}),
        dd.Factor("preshape", [0.0, 1.0], "preshape.amplitude"),
    ],
).save("two-targets.json")
