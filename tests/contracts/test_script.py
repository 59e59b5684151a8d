"""A script that makes a document again makes the same bytes, and reads as a person would write it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import deodar as dd
from deodar.importers import examples
from deodar.importers.opening import load
from deodar.model import document_files
from deodar.model.document import Document
from deodar_studio.catalogue import templates
from tests.contracts import build
from tests.deodar_interop.importers.cosivina.files import SAMPLES

X = dd.Axis("x", 0, 100, samples=101, unit="deg")
ARCHITECTURES = [t.name for t in templates.listed() if t.room == "architectures"]


def made(script: str) -> dd.Model:
    """Return the model that a script makes."""
    space: dict[str, object] = {"__name__": "script"}
    exec(compile(script, "script", "exec"), space)
    return space["make"]()  # type: ignore[operator]


def assert_same(doc: Document) -> str:
    """Check that the script of a document makes the same bytes, and return the script."""
    script = dd.Model(document=doc).to_script()
    assert document_files.dumps(made(script).document, "a") == document_files.dumps(doc, "a")
    return script


# --------------------------------------------------------------------------------------------- the same bytes


@pytest.mark.parametrize("name", examples.names())
def test_the_script_of_an_example_makes_the_same_document(name: str) -> None:
    assert_same(dd.load(f"example:{name}").document)


@pytest.mark.parametrize("name", ARCHITECTURES)
def test_the_script_of_an_architecture_makes_the_same_document(name: str) -> None:
    assert_same(templates.document(name))


@pytest.mark.parametrize("path", SAMPLES, ids=lambda p: p.stem)
def test_the_script_of_an_imported_file_makes_the_same_document(path: Path) -> None:
    assert_same(load(path).document)


def test_the_scripts_of_all_kinds_make_the_same_documents() -> None:
    assert build.KINDS
    assert build.PARTS
    for kind in (*build.KINDS, *build.PARTS):
        assert_same(build.around(build.any_example(kind), noisy=True).document)


def test_the_script_of_an_edited_document_states_the_ids_that_its_paths_do_not_give() -> None:
    model = dd.Model("edited", time_unit="1 = 64 ms", dt=0.5)
    u = model.add(dd.Field("u", [X], kernel=[dd.Gaussian(1.2)]))
    model.add(dd.GaussianStimulus("left", [X], center=30)) >> dd.Gain(2) >> u >> dd.Gain(-0.0)
    v = model.add(dd.Field("v", []), group="outer.inner", ticks=3)
    u >> dd.Project([], reduce="max") >> v
    u["activation"] >> model.add(dd.Product(name="p"), group="outer")["input"]
    model.connect(v, v, reads="delayed")
    model.connect(v, "outer.p.factor", reads="current")
    model.group("empty.other")
    model.rename(u, 'say "u"')
    model.move(v, "")
    model.copy("outer", "copied")
    model.parameter("speed", 17.0)
    model.link("v.tau", "speed")
    model.link("left.center", "speed")
    model.describe(t0=2.5, notes='line\n\\n "quoted" é\ttab ', layout={"boxes": {"a": {"x": 1, "y": 2.0}}})
    script = assert_same(model.document)
    assert f'id="{u.id}"' in script
    assert 'reads="delayed"' in script
    assert "tau" not in script.replace('"v.tau"', "")  # the document parameter gives the value


def test_the_script_links_a_group_to_its_template() -> None:
    template = dd.Model("unit")
    template.add(dd.Field("u", [])) >> dd.Gain(2)
    model = dd.Model("two units")
    for name in ("one", "two"):
        model.insert(template, name, link=True)
    rebuilt = made(assert_same(model.document))
    template["u"].tau = 33
    rebuilt.refresh(template)
    assert rebuilt["two.u"].tau == 33


def test_arrays_travel_in_the_script() -> None:
    rng = np.random.default_rng(0)
    model = dd.Model("arrays")
    for name, weights in {
        "many": rng.normal(size=(101, 101)),
        "again": rng.normal(size=(3, 3)),
        "equal": np.full((101, 101), 0.25),
    }.items():
        axis = dd.Axis(name, 0, 1, samples=weights.shape[1])
        model.add(dd.Weights(weights=weights, axes=[axis], name=name))
    script = assert_same(model.document)
    assert "np.full((101, 101), 0.25)" in script
    assert script.count("arrays[") == 1


# ----------------------------------------------------------------------------------------- readable, harmless


def test_the_script_states_what_differs_from_the_defaults_and_chains_connections() -> None:
    model = dd.Model("first")
    u = model.add(dd.Field("u", [X], tau=10, kernel=[dd.Gaussian(12, 5, normalized=True)]))
    model.add(dd.GaussianStimulus("left", [X], center=30, amplitude=6, windows=[(100, 300)])) >> u
    u >> dd.Gain(2) >> model.add(dd.Field("v", [X]))
    assert (
        model.to_script("first field.json")
        == '''"""Make a model, and write it as a document."""

import deodar as dd


def make() -> dd.Model:
    x = dd.Axis("x", 0, 100, samples=101, unit="deg")
    model = dd.Model("first")
    u = model.add(
        dd.Field("u", [x], tau=10, kernel=[dd.Gaussian(amplitude=12, normalized=True)])
    )
    (
        model.add(
            dd.GaussianStimulus(
                "left", [x], windows=[(100, 300)], center=30, amplitude=6
            )
        )
        >> u
        >> dd.Gain(2)
        >> model.add(dd.Field("v", [x]))
    )
    return model


if __name__ == "__main__":
    dd.save(make(), "first field.json")
'''
    )


def test_scripts_are_formatted_and_without_mistakes_of_style(tmp_path: Path) -> None:
    for name in examples.names():
        (tmp_path / f"{name}.py").write_text(dd.load(f"example:{name}").to_script(), encoding="utf-8")
    for arguments in (["format", "--check"], ["check", "--select", "E,F,I,B,UP"]):
        ruff = [sys.executable, "-m", "ruff", *arguments, "--isolated", "--line-length", "88", str(tmp_path)]
        done = subprocess.run(ruff, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout


def test_text_of_a_document_does_not_become_code() -> None:
    hostile = 'x"); raise SystemExit("run")  # \n    raise SystemExit("run")\n"""\u2028'
    model = dd.Model(hostile)
    axis = dd.Axis(hostile, 0, 1, samples=3, unit=hostile)
    u = model.add(dd.Field(hostile, [axis]), group=dd.quote(hostile))
    u >> model.add(dd.Field("import", [axis])) >> model.add(dd.Field("model", [axis]))
    model["model"] >> model.add(dd.Field("٣", [axis])) >> u
    model.parameter("p", 3)
    model.link("import.tau", "p")
    model.describe(notes=hostile, layout={hostile: hostile})
    script = dd.Model(document=model.document).to_script(hostile)
    assert_same(model.document)
    assert made(script).name == hostile


def test_the_script_of_a_foreign_document_does_not_trust_its_functions(tmp_path: Path) -> None:
    model = dd.Model("own")
    model.add(dd.Function("f", function="os:getcwd", axes=[X]))
    assert "trusted" not in model.to_script()
    dd.save(model, tmp_path / "own.json")
    foreign = dd.load(tmp_path / "own.json")
    assert not made(foreign.to_script()).trusted
    assert_same(foreign.document)


def test_an_id_is_checked() -> None:
    model = dd.Model("m")
    u = model.add(dd.Field("u", []), id="0123abcd")
    assert u.id == "0123abcd"
    with pytest.raises(dd.errors.ParameterError, match="eight hexadecimal digits"):
        model.add(dd.Field("v", []), id="v")
    with pytest.raises(dd.errors.ModelError, match="belongs to another element"):
        model.add(dd.Field("v", []), id="0123abcd")


def test_the_group_of_a_link_has_to_exist() -> None:
    with pytest.raises(dd.errors.UnknownName, match="there is no group 'g'"):
        dd.Model("m").link_group("g", "unit", {})
