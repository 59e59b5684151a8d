"""The old name of `deodar.papers`: importing it raises an error that states the new name."""

from deodar import renamed

raise renamed.moved(__name__)
