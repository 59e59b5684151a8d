"""README.md is short, its pictures show what is drawn now, and a package index can show it."""

from __future__ import annotations

import re
import tomllib
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from markdown_it import MarkdownIt
from PIL import Image

from deodar_papers.story import demo, one_field
from deodar_papers.story.field_moments import FieldThresholds, moments
from deodar_papers.story.figures import field_video
from deodar_papers.story.figures.theme import THEMES
from tests.docs.source import DOCS, ROOT, module

README = (ROOT / "README.md").read_text(encoding="utf-8")
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
RULES = PROJECT["tool"]["hatch"]["metadata"]["hooks"]["fancy-pypi-readme"]
ADDRESS = RULES["substitutions"][1]["replacement"].removesuffix("/blob/v$HFPR_VERSION/")

LARGEST = 1_500_000
"""Bytes of a moving picture."""

front_page = module(DOCS / "front_page.py")


class Targets(HTMLParser):
    """Collects the targets of links and of pictures."""

    def __init__(self) -> None:
        super().__init__()
        self.links: list[str] = []
        self.pictures: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, target in attrs:
            if name == "href":
                self.links.append(target or "")
            elif name in ("src", "srcset"):
                self.pictures.append(target or "")


def description() -> str:
    """Return the description of the distribution, as hatch-fancy-pypi-readme builds it."""
    text = README
    for rule in RULES["substitutions"]:
        text = re.sub(rule["pattern"], rule["replacement"], text)
    return text


def rendered(text: str) -> Targets:
    """Return the targets of a text that is rendered as an index renders it."""
    targets = Targets()
    targets.feed(MarkdownIt("commonmark").enable("table").render(text))
    return targets


def test_the_front_page_has_at_most_eighty_lines() -> None:
    assert len(README.splitlines()) <= 80


def test_with_an_address_no_link_of_the_description_is_relative_and_no_picture_is_missing() -> None:
    targets = rendered(description())
    assert len(targets.links) > 20 and len(targets.pictures) == 7
    relative = [t for t in (*targets.links, *targets.pictures) if not t.startswith("https://")]
    assert not relative, relative
    paths = [
        target.removeprefix(f"{ADDRESS}/{kind}/v$HFPR_VERSION/")
        for kind, places in (("blob", targets.links), ("raw", targets.pictures))
        for target in places
    ]
    assert not [p for p in paths if not (ROOT / p).is_file()]


def test_in_a_clone_links_and_pictures_of_the_front_page_are_files() -> None:
    targets = rendered(README)
    assert not [t for t in (*targets.links, *targets.pictures) if not (ROOT / t).is_file()]


def test_the_ten_lines_build_the_model_of_the_first_act() -> None:
    [block] = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
    names: dict[str, Any] = {}
    exec(block.partition("data =")[0], names)
    written, act = names["model"], one_field.selection()
    written.describe(notes=act.document.notes)
    assert written.document == act.document and len(block.split("\n\n")[1].splitlines()) <= 10


@pytest.mark.parametrize("theme", list(THEMES))
def test_the_moving_picture_of_the_front_page_is_the_one_that_is_drawn_now(theme: str) -> None:
    run = one_field.run(demo.SEED)
    thresholds = FieldThresholds((4.092, 0.012), (-0.826, 0.003))
    drawn = field_video.video(run, moments(run), thresholds, THEMES[theme])
    file = DOCS / "pictures" / front_page.name(theme)
    assert file.stat().st_size < LARGEST
    with Image.open(file) as gif:
        assert gif.size == (960, 600) and abs(gif.n_frames - len(drawn.shots)) <= 12
        first = np.asarray(gif.convert("RGB")).astype(float)
    assert np.abs(first - drawn.shots[0].paint()).mean() < 3, "draw it again: python docs/front_page.py"


def test_the_script_of_the_front_page_writes_both_pictures(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    written: list[Path] = []
    picture = front_page.STORY.figures.moving_picture.MovingPicture
    monkeypatch.setattr(picture, "write", lambda self, path: written.append(path))
    monkeypatch.setattr(front_page, "PICTURES", tmp_path)
    assert front_page.main(tmp_path) == 0
    assert written == [tmp_path / "story-light.gif", tmp_path / "story-dark.gif"]
