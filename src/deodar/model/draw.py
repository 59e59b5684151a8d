"""Draw an architecture."""

from __future__ import annotations

from deodar.errors import ModelError
from deodar.model.diagram import Diagram
from deodar.model.model import Model
from deodar.parameters import show


def draw(model: Model, legend: bool = True, depth: int | None = None) -> Diagram:
    """Draw an architecture as a diagram.

    The diagram shows fields with their axes, nodes, stimuli, sensors and motors, couplings with their signs,
    and groups.

    A coupling with one input and one output is drawn as text on the connection. An arrow is excitation, a dot
    and dashes are inhibition, an arrow with a dot is both. Loops above a field are its own interaction:
    kernels and global inhibition.

    Args:
        model: the model; a model with problems can be drawn too.
        legend: whether a legend below the picture explains the marks in it.
        depth: number of levels of groups that are drawn open; a deeper group is drawn as one box. With 0
            every group is a box. None: all groups are open.

    Returns:
        A `Diagram`: a notebook displays it, `save` writes it to a file.

    Raises:
        ModelError: `model` is not a `Model`, or `depth` is below 0.
    """
    if not isinstance(model, Model):
        raise ModelError(f"expected a Model, got {show(model)}", fix="Give a model: dd.draw(model)")
    if depth is not None and depth < 0:
        raise ModelError(
            f"expected depth as a number of group levels, 0 or more, got {show(depth)}",
            fix="Write depth=0 to draw every group as one box",
        )
    return Diagram(model.document, legend, depth)
