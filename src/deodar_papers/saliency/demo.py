"""Demonstration on three photographs, or on pictures of the user, with figures and records."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from deodar_papers.papers import Demonstration, Show

if TYPE_CHECKING:
    from deodar_papers.saliency.scenes import CueScene, SceneResult

HELP = "a colour cue selects an object in a photograph"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of the demonstration."""
    group = parser.add_argument_group("saliency", HELP)
    source = group.add_mutually_exclusive_group()
    source.add_argument(
        "--image",
        type=Path,
        metavar="FILE",
        help="a photograph of your own instead of the three that come with deodar",
    )
    source.add_argument(
        "--untuned",
        action="store_true",
        default=None,
        help="twelve photographs that were not used to choose parameters",
    )
    source.add_argument(
        "--video", type=Path, metavar="FILE", help="a video of your own, from its beginning (extra vision)"
    )
    source.add_argument(
        "--camera",
        type=int,
        metavar="N",
        help="the present image of a camera, 0 for the first camera (extra vision)",
    )
    group.add_argument(
        "--cue",
        type=float,
        action="append",
        metavar="HUE",
        help="with --image, --video, --camera: a hue to cue, in degrees (0 red, 120 green); may be repeated",
    )


def run(args: argparse.Namespace, show: Show) -> Demonstration:
    """Run all cues on each picture."""
    # start-up time: these bring JAX
    from deodar.figures._files import save_figure
    from deodar.recording import files
    from deodar_papers.figures.cues import overview
    from deodar_papers.saliency import targets
    from deodar_papers.saliency.scenes import CUE_AT, DURATION, run_scene

    scenes = _scenes(args)
    done: list[SceneResult] = []
    drawn = []
    for k, scene in enumerate(scenes):
        show(f"examining {scene.title}", k / len(scenes))
        result = run_scene(scene, args.seed)
        done.append(result)
        drawn.append(result.figure())

    def fill(folder: Path) -> None:
        for result, picture in zip(done, drawn, strict=True):
            save_figure(picture, folder / f"{result.scene.name}.png")
            files.save_record(result.record, folder / f"{result.scene.name}.zarr")
        if len(done) > 1:
            save_figure(overview(done), folder / "overview.png")

    names = [*(f"{r.scene.name}.png" for r in done), *(["overview.png"] if len(done) > 1 else [])]
    return Demonstration(
        claims=[*(c for result in done for c in targets.claims(result)), *targets.totals(done)],
        settings={"duration": DURATION, "cue_at": CUE_AT},
        written=f"{', '.join(names)}, the records (*.zarr)",
        sentence=targets.sentence(done),
        fill=fill,
    )


def _scenes(args: argparse.Namespace) -> list[CueScene]:
    # start-up time: these bring JAX
    from deodar.worlds.camera import Camera
    from deodar_papers.saliency import scenes

    cues = args.cue or ()
    if args.image:
        return [scenes.own(args.image, cues)]
    if args.video:
        return [scenes.filmed(args.video, cues)]
    if args.camera is not None:
        return [scenes.watched(Camera(args.camera, period=scenes.PERIOD), cues)]
    return scenes.photographs(bool(args.untuned))
