"""Descriptions of registered kinds: equation, parameters, ports, reference.

They come from declarations and docstrings alone. The studio, the manual and the command line read them.
"""

from deodar.kinds.description import Description, describe, descriptions
from deodar.kinds.parameter import ParameterDescription, typed

__all__ = ["Description", "ParameterDescription", "describe", "descriptions", "typed"]
