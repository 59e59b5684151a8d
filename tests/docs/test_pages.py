"""Every block of Python and every command on a page runs, prints the text of the page, and draws its
pictures.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from deodar import registry
from tests.docs.source import DOCS, ROOT, module

pages = module(DOCS / "pages.py")

TEXTS = [*sorted(ROOT.glob("*.md")), *sorted(DOCS.rglob("*.md"))]
LINK = re.compile(r"(?<!!)\[[^\]]*\]\(([^)\s]+)\)")
DRAWN_ELSEWHERE = {
    "saliency.md": {"saliency-untuned.png"},  # by `deodar demo saliency --untuned`, made smaller
    "README.md": {
        *(f"studio-{name}.png" for name in ("pointing", "pointing-dark", "world", "world-dark")),
        "story-dark.gif",
        "story-light.gif",
    },
    # by `python docs/demonstrations.py`
    "serial-order.md": {
        *(
            f"serial-order-{name}.png"
            for name in ("transition", "perception", "demonstrations", "sequence", "frame")
        ),
        "serial-order-parameters.png",  # by `python docs/evidence.py FOLDER`
        "studio-lesson.png",
    },
    "looking.md": {"looking.png"},  # by `python docs/evidence.py FOLDER`
    "spa.md": {f"spa-{name}.png" for name in ("success", "divergence", "choice", "routes")},
    "neuromorphic.md": {"neuromorphic-error.png"},  # by `python benchmarks/spikes.py pages`
    "building.md": {"studio-palette.png", "studio-built.png", "studio-wire.png"},
    "gradients.md": {"learned-kernel.png", "fitted-time-course.png"},  # by the scripts in `examples`
    "event-cameras.md": {"studio-eye.png"},
    "experiments.md": {"studio-experiment.png"},
    "studio.md": {p.name for p in (DOCS / "pictures").glob("studio-*.png")},
}
"""The pictures of the README are drawn by `python docs/front_page.py` and by the pages that explain them,
those of the studio by `studio/build.py pictures`, those of many runs by `deodar reproduce`.
"""


@pytest.mark.parametrize("page", pages.pages(), ids=lambda p: p.stem)
def test_a_page_runs(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # a page that explains how to add a kind adds one
    monkeypatch.setattr(registry, "_kinds", dict(registry.kinds()))
    with pages.quiet():
        import matplotlib.pyplot as plt

        drawn = pages.run(page, tmp_path)
        plt.close("all")
    missing = set(pages.pictures(page)) - set(drawn) - DRAWN_ELSEWHERE.get(page.name, set())
    assert not missing, f"{page.name} shows pictures that nothing on it draws: {missing}"


def test_the_pictures_of_architectures_are_those_that_their_page_draws(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Words, shapes and colours agree, and positions to 0.02 points, since an SVG rounds them."""
    number = re.compile(r"-?\d+(?:\.\d+)?")
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for block in pages.blocks(DOCS / "drawing.md"):
        if block.language == "python" and "dd.draw(" in block.text:
            pages._run(block, names)
    vectors = sorted(tmp_path.glob("*.svg"))
    assert len(vectors) >= 3
    for path in vectors:
        shown, drawn = ((place / path.name).read_text("utf-8") for place in (DOCS / "pictures", tmp_path))
        changed = f"{path.name} changed: python docs/build.py --pages drawing"
        assert number.sub("#", shown) == number.sub("#", drawn), changed
        positions = [[float(n) for n in number.findall(text)] for text in (shown, drawn)]
        assert positions[0] == pytest.approx(positions[1], abs=0.02), changed


def _broken(page: Path) -> Iterator[str]:
    """Yield the links of a page to files or headings that do not exist."""
    text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    for link in (link for link in LINK.findall(text) if not link.startswith(("https://", "http://"))):
        place, _, anchor = link.partition("#")
        target = (page.parent / place) if place else page
        heads = re.findall(r"^#+ (.*)$", target.read_text("utf-8"), re.MULTILINE) if anchor else []
        anchors = {re.sub(r"[^\w-]", "", head.lower().replace(" ", "-")) for head in heads}
        if not target.exists() or (anchor and anchor not in anchors):
            yield link


def test_links_of_pages_lead_to_files_and_headings() -> None:
    broken = [f"{page.relative_to(ROOT)}: {link}" for page in TEXTS for link in _broken(page)]
    assert not broken, broken


def test_a_broken_link_is_found(tmp_path: Path) -> None:
    (tmp_path / "other.md").write_text("# One head\n")
    page = tmp_path / "page.md"
    page.write_text("[a](other.md#one-head) [b](other.md#two) [c](gone.md) [d](#here)\n\n# Here\n")
    assert list(_broken(page)) == ["other.md#two", "gone.md"]


def test_pictures_of_pages_are_small_files() -> None:
    shown = {name for page in TEXTS for name in pages.pictures(page)}
    sizes = {name: (DOCS / "pictures" / name).stat().st_size for name in shown}
    large = {
        name: size
        for name, size in sizes.items()
        if size >= (1_500_000 if name.endswith(".gif") else 400_000)
    }
    assert sizes and not large


def test_every_page_is_in_the_table_of_contents() -> None:
    listed = set(
        re.findall(r": ([\w/-]+\.md)$", (ROOT / "mkdocs.yml").read_text(encoding="utf-8"), re.MULTILINE)
    )
    found = {p.relative_to(DOCS).as_posix() for p in DOCS.rglob("*.md")}
    assert listed == {page for page in found if not page.startswith("decisions/")}


def test_every_picture_is_shown_on_a_page() -> None:
    shown = {name for page in TEXTS for name in pages.pictures(page)}
    assert {p.name for p in (DOCS / "pictures").iterdir()} == shown


@pytest.mark.parametrize(
    ("expected", "printed", "good"),
    [
        ("a 1.00 b\n", "a 1.01 b\n", True),
        ("a 1.00 b\n", "a 1.05 b\n", False),
        ("a\n...\nc\n", "a\nb\nc\n", True),
        ("a\n...\n", "a\nb\nc\n", True),
        ("a\n", "a\nb\n", False),
        ("a\nb\n", "a\n", False),
        ("[1, 2]\n", "[1, 2, 3]\n", False),
    ],
)
def test_printed_output_is_compared_with_a_tolerance(expected: str, printed: str, good: bool) -> None:
    assert (pages.difference(expected, printed) == "") is good


def test_a_page_with_wrong_output_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = tmp_path / "page.md"
    page.write_text("```python\nprint(2 + 2)\n```\n\n```text\n5\n```\n")
    monkeypatch.setattr(pages, "ROOT", tmp_path)
    (tmp_path / "examples").mkdir()
    (tmp_path / "here").mkdir()
    with pytest.raises(AssertionError, match=r"page.md:2: '5' on the page, '4' printed"):
        pages.run(page, tmp_path / "here")
