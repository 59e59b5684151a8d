"""The gallery: every example has a title, a sentence and a small picture, and other names are refused."""

from __future__ import annotations

import pytest
from PIL import Image

import deodar as dd
from deodar.errors import UnknownName
from deodar.importers.examples import LONGEST
from deodar.importers.examples import first_sentence as sentence
from deodar_studio.catalogue.gallery import example_file, examples, picture_file
from tests.docs.source import EXAMPLES

NAMES = [e.name for e in examples()]


def test_every_document_of_the_folder_is_an_example() -> None:
    assert sorted(NAMES) == sorted(p.stem for p in EXAMPLES.glob("*.json"))


def test_the_order_names_examples_that_exist() -> None:
    order = (EXAMPLES / "order.txt").read_text(encoding="utf-8").split()
    assert NAMES[: len(order)] == order


def test_an_example_has_a_title_a_sentence_and_a_picture() -> None:
    for example in examples():
        assert example.title[0].isupper(), example
        assert 20 < len(example.sentence) <= LONGEST and example.sentence.endswith("."), example
        assert not example.sentence.startswith(f"{example.title}."), example
        assert example.picture == f"examples/{example.name}.png"
        path = picture_file(example.name)
        assert path is not None and path.stat().st_size < 15_000, example
        with Image.open(path) as picture:
            assert picture.size == (320, 200), example
        assert dd.load(example_file(example.name)).document.name, example


@pytest.mark.parametrize("name", ["", "nothing", "../README", "make", "order", "/etc/passwd"])
def test_names_outside_of_the_examples_are_refused(name: str) -> None:
    assert picture_file(name) is None
    with pytest.raises(UnknownName):
        example_file(name)


def test_an_unknown_example_suggests_the_nearest() -> None:
    with pytest.raises(UnknownName, match="selection"):
        example_file("selektion")


def test_the_sentence_of_an_example_is_the_first_of_its_notes() -> None:
    assert sentence("Switch. On and off. And more.", "switch") == "On and off."
    assert sentence("On at 0.5 ms, in u. More.", "switch") == "On at 0.5 ms, in u."
    assert sentence("", "switch") == ""


def test_a_long_sentence_is_cut_at_a_comma() -> None:
    long = "A peak that stays here for a while, " + "and stays " * 20 + "still."
    assert sentence(long, "x") == "A peak that stays here for a while."
    assert len(sentence("and " * 100, "x")) <= LONGEST and sentence("and " * 100, "x").endswith("…")
