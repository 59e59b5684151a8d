"""Draw an architecture."""

from __future__ import annotations

from deodar.errors import ModelError
from deodar.model.diagram import Diagram
from deodar.model.model import Model
from deodar.parameters import show


def draw(model: Model, legend: bool = True, depth: int | None = None) -> Diagram:
    """Draw an architecture: fields with their axes, nodes, stimuli, sensors and motors, couplings with their
    signs, groups.

    Couplings with one connection in and one out are text on that connection. An arrow is excitation, a dot
    inhibition, an arrow with a dot both. Loops above a field are its own interaction: of its kernels, and
    global inhibition.

    Args:
        model: the model; one with problems is drawn too.
        legend: whether the marks that occur are explained below the picture.
        depth: how many levels of groups are drawn open; each group below is one box. With 0 every group is a
            box; none: all are open.

    Returns:
        A `Diagram`: a notebook shows it, `save` writes it.

    Raises:
        ModelError: this is no model, or `depth` is below 0.
    """
    if not isinstance(model, Model):
        raise ModelError(f"expected a Model, got {show(model)}", fix="Give a model: dd.draw(model)")
    if depth is not None and depth < 0:
        raise ModelError(
            f"depth is {show(depth)}; it counts levels of groups, from 0",
            fix="Write depth=0 to draw every group as one box",
        )
    return Diagram(model.document, legend, depth)
