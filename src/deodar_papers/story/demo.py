"""The demonstration without a name: one field, then the same on a photograph, each as a moving picture."""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from deodar import regular_file
from deodar.cli._options import shown
from deodar.model import output
from deodar_papers.papers import Demonstration, Show

if TYPE_CHECKING:
    from deodar_papers.story.figures.moving_picture import MovingPicture

HELP = "one field detects, selects, remembers and forgets, then the same on a photograph (default)"

SEED = 12
"""With this seed both inputs have a peak for 40 ms before one wins."""

FOLDER = "deodar-demo"
MODEL = "selection.json"

HEAD = "deodar: one field, then the same on a photograph (20 s of computing)"

NOW_TRY = (
    ("deodar studio", "build, run and tune in the browser"),
    ("deodar studio example:selection", "the second scene, with sliders"),
    ("docs/instabilities.md", "how these numbers are measured"),
)


@dataclass(frozen=True)
class Story(Demonstration):
    """The demonstration, whose verdicts are printed during its run."""

    def lines(self, out: Path) -> Iterator[str]:
        """Yield what is printed after the folder `out` is written."""
        yield f"Both are in {shown(out)}/. Now try"
        yield from (f"     {command:<34} {purpose}" for command, purpose in NOW_TRY)


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of the demonstration."""
    group = parser.add_argument_group("story", HELP)
    group.add_argument(
        "--theme", choices=("light", "dark"), help="story: colours of the moving pictures (default light)"
    )
    group.add_argument(
        "--mp4", action="store_true", default=None, help="story: also write videos in MP4 (extra video)"
    )


def run(args: argparse.Namespace, show: Show) -> Story:
    """Run and draw both acts; a line is printed when each is done."""
    # start-up time: these bring JAX
    from deodar.analysis.regimes import regimes
    from deodar.figures import _encode
    from deodar.model import document_files
    from deodar_papers.saliency import targets
    from deodar_papers.story import field_moments, one_field, photograph
    from deodar_papers.story.figures import field_video, photograph_video
    from deodar_papers.story.figures.theme import THEMES

    endings = (".gif", ".mp4") if args.mp4 else (".gif",)
    if args.mp4:
        _encode.ffmpeg()  # an error before the run
    theme = THEMES[args.theme or "light"]
    show.line(f"{HEAD}\n")

    began = time.perf_counter()
    show("computing the run of a field", 0.0)
    field_run = one_field.run(args.seed)
    show("computing its thresholds", 0.1)
    measured = field_moments.FieldThresholds.of(regimes(one_field.field()))
    moments = field_moments.moments(field_run)
    show("drawing the story", 0.2)
    video = field_video.video(field_run, moments, measured, theme)
    files = dict(_written(video, "story", endings))
    _tell(show, f"1  {'The story of one field':<45}", video, "story.gif", began)
    _tell_verdicts(show, field_moments.verdicts(moments, measured))

    began = time.perf_counter()
    show("computing the photograph", 0.5)
    scene = photograph.run(args.seed)
    courses = photograph.courses(scene)
    show("drawing the photograph", 0.8)
    video = photograph_video.video(scene, courses, theme)
    files |= _written(video, "photograph", endings)
    _tell(show, f"2  {'The same on a photograph':<45}", video, "photograph.gif", began)
    _tell_verdicts(show, [(course.name, photograph.verdict(course)) for course in courses])

    def fill(folder: Path) -> None:
        for name, content in files.items():
            output.write(folder / name, content)
        document_files.save(one_field.selection().document, folder / MODEL)

    return Story(
        claims=[*field_moments.claims(moments, measured), *targets.claims(scene)],
        settings={"theme": args.theme or "light"},
        written=", ".join([*files, MODEL]),
        sentence=f"{field_moments.summary(moments)} {photograph.summary(courses)}",
        fill=fill,
        model=MODEL,
    )


def _written(video: MovingPicture, name: str, endings: Sequence[str]) -> Mapping[str, bytes]:
    """Return the content of the files of a video by their names."""
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder) / f"{name}{ending}" for ending in endings]
        for path in paths:
            video.write(path)
        return {path.name: regular_file.read_bytes(path) for path in paths}


def _tell(show: Show, title: str, video: MovingPicture, name: str, began: float) -> None:
    """Print the line of an act: its title, its video, and the seconds that it took."""
    took = f"{time.perf_counter() - began:.0f} s"
    show.line(f"{title}{f'{name}, {video.seconds:.0f} s':<20}{took:>7}")


def _tell_verdicts(show: Show, verdicts: Sequence[tuple[str, str]]) -> None:
    for name, says in verdicts:
        show.line(f"     {name:<13} {says}")
