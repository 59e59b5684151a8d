"""What a script returns shows itself in a notebook: a few lines, in the colours of the theme."""

from __future__ import annotations

import dataclasses as dc
import inspect
import re
import typing
import xml.etree.ElementTree as ET
from typing import Any

import pytest

import deodar as dd
from deodar.analysis.thresholds import Transition
from deodar.parameters import Part
from deodar.summary import LARGEST, Summary

STRANGE = "<img src=x onerror=alert(1)> & \x07"
"""Text of a user that is neither markup nor printable."""

FOR_AUTHORS = {"Exact", "ExactQuantity", "FieldInput", "PositionUnit", "SettledBatch", "StepInputs", "View"}
"""What methods return to those who write kinds, requirements and figures."""

LIMIT = 20_000
"""Most characters of the HTML of an object: a notebook stores it at each run."""


def field_model(name: str = STRANGE) -> tuple[dd.Model, Any]:
    """Return a field with an input, under a strange name."""
    x = dd.Axis("x", 0, 30, samples=31, unit="<mm>")
    model = dd.Model(name)
    u = model.add(
        dd.Field("u", [x], tau=10, kernel=[dd.Gaussian(20, 3, normalized=True)], global_inhibition=1)
    )
    model.add(dd.GaussianStimulus(STRANGE[:-2], [x], center=15, sigma=3, amplitude=6)) >> u
    return model, u


def objects_of_scripts() -> dict[str, tuple[object, str]]:
    """Return each kind of object with a text that its lines contain: its name, or a main number."""
    model, u = field_model()
    session = dd.Session(model)
    path = model.document.entries[1].path
    amplitude = f"{path}.amplitude"
    meter = session.run_live(20, speed=None)
    experiment = dd.Experiment(
        "six trials",
        model,
        dd.TrialPlan(50, events=[dd.Appears("detected", "u")]),
        trials=3,
        factors=[dd.Factor("<b>", [0.0, 6.0], amplitude)],
    )
    regimes = dd.regimes(model, "u")
    regime_map = dd.regime_map(
        model, {"u.resting_level": (-6, -4, 2), "u.global_inhibition": (0.5, 1.5, 2)}, "u"
    )
    record = dd.simulate(model, 20, record=["u.activation"])
    return {
        "model": (model, "2 elements"),
        "handle": (u, "Field u"),
        "kernel": (u.kernel[0], "u.kernel.0"),
        "axis": (u.axes[0], "31 samples"),
        "session": (session, "at 20 ms"),
        "meter": (meter, "20"),
        "costs": (session.costs(seconds=0.01), "us a step"),
        "snapshot": (session.snapshot(), "20 ms"),
        "record": (record, "u.activation"),
        "peaks": (dd.peaks(record["u.activation"].isel(time=-1)), "peak"),
        "experiment": (experiment, "six trials"),
        "results": (experiment.run(), "6 trials"),
        "regimes": (regimes, "detection"),
        "thresholds": (regimes.thresholds, "detection"),
        "selection": (regimes.selection, "two equal inputs"),
        "ramp": (regimes.ramp, "bistable"),
        "branch": (dd.continuation(model, amplitude, (0, 8), even=["x"], finer=False), "steady states"),
        "map": (regime_map, "2 x 2 cells"),
        "phase": (dd.phase(dd.Field("node", [])), "fixed point"),
        "problem": (dd.errors.Problem("u", STRANGE), "problem"),
        "figure file": (dd.figures.FigureFile([dd.figures.FigurePanel("u.activation")]), "u.activation"),
    }


@pytest.fixture(scope="module")
def objects() -> dict[str, tuple[Any, str]]:
    """Return the objects, made once."""
    return objects_of_scripts()


def test_objects_show_themselves_in_a_few_lines_that_follow_the_theme(objects) -> None:
    for name, (instance, words) in objects.items():
        markup = instance._repr_html_()
        root = ET.fromstring(markup)
        assert root.tag == "div", name
        assert words in "".join(root.itertext()), (name, markup)
        assert len(markup) < LIMIT, (name, len(markup))
        assert "<img" not in markup and "<b>&lt;mm" not in markup, (name, "text of the user is escaped")
        assert not re.search(r"#fff|#000|white|black|<style|<script", markup), (name, "colours of the theme")


def test_no_text_is_a_dump_of_fields(objects) -> None:
    for name, (instance, _) in objects.items():
        text = repr(instance)
        assert len(text) < 2000 and "array(" not in text and "=<" not in text, (name, text[:300])
        assert not re.match(r"\w+\(\w+=", text), (name, text[:300])


def test_figures_are_pictures_that_pyplot_does_not_show_again(objects) -> None:
    record, model = objects["record"][0], objects["model"][0]
    for figure in (dd.time_course(record["u.activation"], places=[15]), dd.draw(model).figure()):
        assert figure._repr_png_().startswith(b"\x89PNG")
        assert figure.number if hasattr(figure, "number") else not figure.canvas.manager


def test_a_large_model_stays_small_and_names_its_picture() -> None:
    markup = dd.load("example:spa")._repr_html_()
    assert len(markup) < LIMIT and "dd.draw(model)" in markup
    assert "129 elements" in "".join(ET.fromstring(markup).itertext())


def test_the_picture_of_a_model_has_the_ink_and_the_page_of_the_theme() -> None:
    markup = dd.load("example:binding")._repr_html_()
    assert "<svg" in markup and 'fill="currentColor"' in markup and 'fill="var(--page)"' in markup
    assert "background" not in markup.replace("--vscode-editor-background", "")


def test_long_tables_are_folded_and_end_with_the_number_of_further_rows() -> None:
    summary = Summary("many", [(f"row {k}", "x" * 500) for k in range(1000)])
    markup = summary.html()
    assert len(markup) < LARGEST + 500 and "<details><summary>1000 rows</summary>" in markup
    rows = re.findall(r"<tr><td>row \d+</td>", markup)
    assert f"... and {1000 - len(rows)} more" in markup and "x" * 200 not in markup
    assert summary.text.count("\n") == 1000, "a console shows all"
    assert ET.fromstring(markup).tag == "div"


def test_truth_nothing_and_numbers_are_words_and_six_digits() -> None:
    rows = [("ready", True), ("left", False), ("file", None), ("share", 1 / 3)]
    assert Summary("parts", rows).text == (
        "<parts\n  ready  yes\n  left   no\n  file   none\n  share  0.333333>"
    )


def test_a_transition_is_its_input_and_half_of_its_interval() -> None:
    words = [repr(Transition(2.0, 1.9, 2.1, (1.5, 2.5), jump, Any)) for jump in (True, False)]
    assert words == ["<Transition at 2 +- 0.5, a jump>", "<Transition at 2 +- 0.5, gradual>"]


def returned(function: Any) -> list[type]:
    """Return the classes of deodar in the annotation of what a function returns."""
    try:
        annotation = typing.get_type_hints(function).get("return")
    except (NameError, TypeError):
        return []
    classes = [annotation, *typing.get_args(annotation)]
    return [c for c in classes if isinstance(c, type) and c.__module__.split(".")[0].startswith("deodar")]


def test_public_functions_return_objects_that_show_themselves() -> None:
    """What a user declares, such as an element or an action, is markup as it is written."""
    public = [getattr(dd, name) for name in dd.__all__]
    public += [getattr(module, name) for module in (dd.analysis, dd.figures) for name in module.__all__]
    dumps: list[str] = []
    for public_object in public:
        functions = [public_object] if inspect.isfunction(public_object) else []
        if isinstance(public_object, type) and not issubclass(public_object, Part | dd.World):
            functions += [m for n, m in inspect.getmembers(public_object, inspect.isfunction) if n[0] != "_"]
        for function in functions:
            for kind in returned(function):
                generated = dc.is_dataclass(kind) and hasattr(kind.__repr__, "__wrapped__")
                if generated and not issubclass(kind, Part) and kind.__name__ not in FOR_AUTHORS:
                    dumps.append(f"{function.__qualname__}: {kind.__qualname__}")
    assert not dumps, "\n".join(dumps)
