"""Write `every.json`: elements over one to four axes that share a unit, a picture, fixed weights, and a ring.

Patterns have values that follow from the position, so that a test can read them at the cursor.
"""

import numpy as np

import deodar as dd

x, y, z = (dd.Axis(n, 0, u, samples=u + 1, unit="cm") for n, u in (("x", 20), ("y", 10), ("z", 5)))
w = dd.Axis("w", 0, 3, samples=4, unit="deg")
ring = dd.Axis("angle", 0, 360, samples=36, unit="deg", periodic=True)
long = dd.Axis("long", 0, 999, samples=1000)
channel = dd.Axis("channel", 0, 2, samples=3)
model = dd.Model("every")
kernel = [dd.Gaussian(8.0, 2.0, normalized=True)]
line = model.add(dd.Field("line", [x], kernel=kernel))
lower = model.add(dd.Field("lower", [y]))
weights = np.arange(21.0)[:, None] - 2 * np.arange(11.0)
lower >> model.add(dd.Weights(weights, [x], name="map")) >> line
other = model.add(dd.Field("other", [x]))
model.add(dd.Field("plane", [x, y], kernel=kernel))
model.add(dd.Field("fellow", [x, y]))
model.add(dd.Field("volume", [x, y, z]))
i, j, k, l = np.meshgrid(*(np.arange(float(a.samples)) for a in (x, y, z, w)), indexing="ij")
model.add(dd.Pattern("flat", [x, y], values=(i + 100 * j)[:, :, 0, 0]))
model.add(dd.Pattern("four", [x, y, z, w], values=100 * l + 10 * k + i / 100))
model.add(dd.Pattern("picture", [x, y, channel], values=np.stack([i / 20, j / 10, 0 * i], 2)[..., 0, 0]))
model.add(dd.Pattern("far", [long], values=np.arange(1000.0)))
model.add(dd.Field("ring", [ring]))
model.add(dd.Field("node", [], resting_level=-2))
dd.save(model, "every.json")
