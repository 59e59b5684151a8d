"""Demonstrations on real input: `deodar demo NAME`, or `dd.demos.saliency.look(...)`."""

from deodar.demos import saliency, saliency_figure, spa, spa_figure, spa_film

__all__ = ["saliency", "saliency_figure", "spa", "spa_figure", "spa_film"]
