"""The moving pictures of README.md: the first act of `deodar demo`, light and dark.

    python docs/front_page.py

Draw them again after a change of the story; a test compares their lines, sizes and lengths with it.
"""

from __future__ import annotations

import sys
from pathlib import Path

import deodar as dd

STORY = dd.papers.story
PICTURES = Path(__file__).parent / "pictures"


def name(theme: str) -> str:
    """Return the name of the picture of a theme."""
    return f"story-{theme}.gif"


def main(folder: Path = PICTURES) -> int:
    """Draw both pictures of one run; return status 0."""
    run = STORY.one_field.run(STORY.demo.SEED)
    moments = STORY.field_moments.moments(run)
    measured = STORY.field_moments.FieldThresholds.of(dd.regimes(STORY.one_field.field()))
    for theme, colours in STORY.figures.theme.THEMES.items():
        path = folder / name(theme)
        path.unlink(missing_ok=True)
        STORY.figures.field_video.video(run, moments, measured, colours).write(path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
