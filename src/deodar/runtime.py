"""The old name of three packages: importing it raises an error that states the new names."""

from deodar import renamed

raise renamed.moved(__name__)
