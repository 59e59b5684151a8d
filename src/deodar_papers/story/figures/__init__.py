"""The moving pictures of the story."""

from deodar_papers import papers

__getattr__ = papers.files(__name__)
