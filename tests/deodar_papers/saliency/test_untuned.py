"""The untuned photographs: their marks and licences, and runs of two of them; `deodar demo saliency
--untuned` runs all twelve.
"""

from __future__ import annotations

from importlib import resources

from deodar_papers.saliency.scenes import NEAR, Cue, Found, photographs, run_scene
from deodar_papers.saliency.targets import claims, totals

FOLDER = resources.files("deodar_papers.saliency") / "photographs"


def test_each_photograph_has_a_present_and_an_absent_cue_and_marks_inside_the_picture() -> None:
    scenes = photographs(untuned=True)
    assert len(scenes) == 12
    for scene in scenes:
        width, height = scene.picture.size
        assert [c.expect for c in scene.cues] == ["present", "absent"] and not scene.tuned
        for outline in scene.cues[0].outlines:
            assert len(outline) >= 3 and all(0 <= x <= width and 0 <= y <= height for x, y in outline)


def test_a_field_at_the_threshold_is_not_below_it() -> None:
    scene = photographs(untuned=True)[0]
    holds = [claims(Found(scene=scene, quiet=quiet))[0].holds for quiet in (None, -0.5, 0.0, 0.5)]
    assert holds == [None, True, False, False]


def test_marked_regions_do_not_cover_most_of_a_picture() -> None:
    for scene in (*photographs(), *photographs(untuned=True)):
        width, height = scene.picture.size
        grid = [(x, y) for x in range(0, width, 10) for y in range(0, height, 10)]
        for cue in scene.cues:
            assert sum(map(cue.holds, grid)) < 0.5 * len(grid), (scene.name, cue.name)


def test_an_outline_inside_another_is_a_hole() -> None:
    square = ((0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0))
    hole = ((4.0, 4.0), (6.0, 4.0), (6.0, 6.0), (4.0, 6.0))
    cue = Cue(0.0, outlines=(square, hole))
    assert (
        cue.holds((2.0, 5.0))
        and cue.holds((8.0, 5.0))
        and not cue.holds((5.0, 5.0))
        and not cue.holds((12.0, 5.0))
    )


def test_every_photograph_has_its_author_and_licence() -> None:
    text = (FOLDER / "LICENCES.md").read_text()
    names = [
        p.name for folder in (FOLDER, FOLDER / "untuned") for p in folder.iterdir() if p.name.endswith(".jpg")
    ]
    assert len(names) == 15
    assert all(f"| `{name}` |" in text for name in names)


def test_a_strong_peak_moves_the_motor_variable_to_it_and_a_weak_one_does_not_in_time() -> None:
    scenes = {scene.name: scene for scene in photographs(untuned=True)}
    bird, clock = run_scene(scenes["bird"]), run_scene(scenes["clock"])
    for outcome in (bird, clock):
        present, absent = outcome.outcomes
        assert present.right and absent.right and absent.converged
    assert bird.outcomes[0].converged
    gap = clock.outcomes[0].gap
    assert gap is not None and gap > 5 * NEAR
    assert all(c.kind == "reported" for c in claims(clock)), "of one untuned photograph nothing is required"
    right, silent, motor = totals([bird, clock])
    assert (right.value, silent.value, motor.value) == (2, 2, 1)
    assert right.holds is False and silent.holds is True and motor.holds is False
