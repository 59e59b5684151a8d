"""Questions that the user must answer before a request is carried out."""

from __future__ import annotations

from typing import Literal

Ask = Literal["unsaved", "unsaved_experiment", "replace"]


class ConfirmationRequired(Exception):
    """A question that the user must answer before the request can be repeated.

    Args:
        question: the question.
        file: the file that would be replaced, as the page names it; empty: the one that the request names.
    """

    def __init__(self, question: Ask, file: str = "") -> None:
        self.question: Ask = question
        self.file = file
        super().__init__(question)
