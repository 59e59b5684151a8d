"""The first demonstration: the story of one field, and the same on a photograph, each as a moving picture."""

from deodar_papers import papers

__getattr__ = papers.files(__name__)
