"""Functions of foreign documents are inert until trusted; functions of users that fail raise clear errors."""

from __future__ import annotations

import pickle
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar import cli
from deodar.elements.function import Function
from deodar.errors import ModelError, NotFinite, UnknownName, Untrusted
from deodar.model import document_files, edit
from tests.deodar.errors.refused import refused

X = dd.Axis("x", 0, 10, samples=11)


@pytest.fixture
def stranger(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Write a module that leaves a mark when it is imported, and a document that names a function of it."""
    mark = tmp_path / "it ran"
    (tmp_path / "strangers_module.py").write_text(
        f"from pathlib import Path\nPath({str(mark)!r}).write_text('x')\ndef step(state, inputs, time):\n   "
        " return state + inputs['input']\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    model = dd.Model("strange")
    f = model.add(Function("f", [X], function="strangers_module:step"))
    model.add(dd.GaussianStimulus("s", [X])) >> f
    dd.save(model, tmp_path / "strange.json")
    assert not mark.exists()
    yield mark
    sys.modules.pop("strangers_module", None)


def test_reading_checking_and_editing_never_import_a_function(
    stranger: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = stranger.with_name("strange.json")
    model = dd.load(path)
    assert model.check() == []
    model.set("f.initial", 1.0)
    model.copy  # noqa: B018
    model.rename("f", "g")
    model.to_json()
    model._repr_html_()
    dd.save(model, stranger.with_name("copy.json"))
    assert cli.main(["check", str(path)]) == 0
    assert cli.main(["check", str(path), "--json"]) == 0
    assert not stranger.exists() and "strangers_module" not in sys.modules
    capsys.readouterr()


@pytest.mark.parametrize(
    "run", [lambda m: dd.simulate(m, 5, record="f.output"), dd.Session], ids=["simulate", "Session"]
)
def test_running_a_function_requires_trust(stranger: Path, run: Callable[[dd.Model], Any]) -> None:
    path = stranger.with_name("strange.json")
    refused(
        lambda: run(dd.load(path)),
        Untrusted,
        "f: the document asks to run the function 'strangers_module:step'",
        "trust=True",
    )
    assert not stranger.exists()


def test_a_trusted_function_runs(stranger: Path) -> None:
    model = dd.load(stranger.with_name("strange.json"), trust=True)
    record = dd.simulate(model, 5, record="f.output")
    assert stranger.exists()
    assert float(record["f.output"].isel(time=-1).max()) > 4


def test_trust_of_a_model_does_not_extend_to_inserted_models(stranger: Path) -> None:
    """A foreign document stays foreign when it is inserted into a user's model; trust is given where a
    document is read.
    """
    path = stranger.with_name("strange.json")
    loaded = dd.load(path)
    loaded.insert(dd.load(path), "twin")
    refused(lambda: dd.simulate(loaded, 5, record="f.output"), Untrusted)
    custom = dd.Model("own")
    custom.insert(loaded, "theirs")
    refused(lambda: dd.simulate(custom, 5, record="theirs.f.output"), Untrusted)
    assert not stranger.exists()


def test_a_model_is_trusted_again_after_an_insert_is_undone(stranger: Path) -> None:
    custom = dd.Model("own")
    custom.insert(dd.load(stranger.with_name("strange.json")), "theirs")
    assert not custom.trusted
    custom.undo()
    assert custom.trusted
    for name in ("u", "v"):
        custom.add(dd.Field(name, []))
        assert custom.trusted
    dd.simulate(custom, 5, record="u")


def raises(state: Any, inputs: Any, time: Any) -> Any:
    raise RuntimeError("no luck today\nand a second line")


def wrong_shape(state: Any, inputs: Any, time: Any) -> Any:
    return np.zeros(3)


def one_number(state: Any, inputs: Any, time: Any) -> Any:
    return 1.0


def nothing(state: Any, inputs: Any, time: Any) -> Any:
    return None


def words(state: Any, inputs: Any, time: Any) -> Any:
    return "words"


def imaginary(state: Any, inputs: Any, time: Any) -> Any:
    return state * 1j


def branches(state: Any, inputs: Any, time: Any) -> Any:
    return state if state.sum() > 0 else -state


def too_few(state: Any) -> Any:
    return state


def undefined(state: Any, inputs: Any, time: Any) -> Any:
    return state / 0.0


NOT_A_FUNCTION = 5

FUNCTIONS: dict[str, tuple[Any, type[Exception], tuple[str, ...]]] = {
    "raises": (
        raises,
        ModelError,
        (
            "f: ",
            "tests.deodar.errors.test_bad_functions:raises",
            "raised RuntimeError: no luck today",
            "function(state, inputs, time, **values)",
        ),
    ),
    "another shape": (
        wrong_shape,
        ModelError,
        ("f: ", "wrong_shape returned", "of shape [3]; its state has real numbers of shape [11]"),
    ),
    "one number": (one_number, ModelError, ("of shape []; its state has real numbers of shape [11]",)),
    "nothing": (nothing, ModelError, ("f: ", "nothing raised")),
    "words": (words, ModelError, ("f: ", "words raised")),
    "imaginary": (imaginary, ModelError, ("returned complex64 numbers",)),
    "not for JAX": (branches, ModelError, ("branches raised TracerBoolConversionError", "traced by JAX")),
    "too few arguments": (too_few, ModelError, ("too_few raised TypeError",)),
    "not there": (
        "tests.deodar.errors.test_bad_functions:absent",
        UnknownName,
        ("f: ", "cannot be found", "module:name"),
    ),
    "no such module": ("no_such_module_here:step", UnknownName, ("no_such_module_here",)),
    "no function": (
        "tests.deodar.errors.test_bad_functions:NOT_A_FUNCTION",
        ModelError,
        ("is 5, which is not a function",),
    ),
    "no colon": ("math", UnknownName, ("cannot be found", "module:name")),
    "nothing named": ("", UnknownName, ("cannot be found",)),
    "a colon alone": (":", UnknownName, ("cannot be found",)),
    "a relative name": (".module:step", UnknownName, ("cannot be found",)),
}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_failing_function_is_an_error_that_names_it(name: str) -> None:
    function, error, says = FUNCTIONS[name]
    model = dd.Model("m")
    model.add(Function("f", [X], function=function))
    refused(lambda: dd.simulate(model, 5, record="f.output"), error, *says)  # type: ignore[arg-type]


def test_a_module_that_raises_at_import_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "broken_module_of_mine.py").write_text("raise RuntimeError('broken')\n")
    monkeypatch.syspath_prepend(tmp_path)
    model = dd.Model("m")
    model.add(Function("f", [X], function="broken_module_of_mine:step"))
    refused(
        lambda: dd.simulate(model, 5, record="f.output"),
        UnknownName,
        "cannot be found (RuntimeError: broken)",
    )


def test_the_cause_of_an_error_in_a_user_function_is_kept() -> None:
    """The message is one of deodar, and the cause keeps its line."""
    model = dd.Model("m")
    model.add(Function("f", [X], function=raises))
    with pytest.raises(ModelError) as caught:
        dd.simulate(model, 5, record="f.output")
    assert isinstance(caught.value.__cause__, RuntimeError)


def test_a_parameter_that_the_function_does_not_have_is_an_error() -> None:
    model = dd.Model("m")
    model.add(Function("f", [X], function="deodar.elements.function:leaky", values={"rat": 1.0}))
    refused(lambda: dd.simulate(model, 5, record="f.output"), ModelError, "raised TypeError", "'rat'")


def test_an_input_that_the_element_does_not_have_is_an_error() -> None:
    model = dd.Model("m")
    model.add(Function("f", [X], function="deodar.elements.function:leaky", ports_in=["drive"]))
    refused(lambda: dd.simulate(model, 5, record="f.output"), ModelError, "raised KeyError: 'input'")


def test_a_function_that_divides_by_zero_names_element_and_step() -> None:
    model = dd.Model("m")
    model.add(Function("f", [X], function=undefined))
    refused(
        lambda: dd.simulate(model, 5, record="f.output"),
        NotFinite,
        "f became infinite or undefined in step 1 (time 1 ms, dt 1)",
    )


def test_functions_of_an_untrusted_document_do_not_run(stranger: Path) -> None:
    document = document_files.load(stranger.with_name("strange.json"))
    model = dd.Model(document=document)
    assert not model.trusted
    refused(lambda: dd.simulate(model, 5, record="f.output"), Untrusted, "trusted=True")
    model.set("f.initial", 0.5)
    custom = dd.Model("own")
    custom.insert(model, "theirs")
    packed = pickle.loads(pickle.dumps(dd.Model(document=document, trusted=True).document))
    for one in (model.document, custom.document, packed, edit.remove(custom.document, [])):
        assert not dd.Model(document=one).trusted
    assert not stranger.exists()


def test_a_loaded_model_keeps_the_trust_stated_by_the_script(stranger: Path) -> None:
    loaded = dd.load(stranger.with_name("strange.json"), trust=True)
    loaded.set("f.initial", 0.5)
    custom = dd.Model("own")
    custom.add(Function("f", function="math:sqrt"))
    problem = dd.Model(document=document_files.load(stranger.with_name("strange.json")), trusted=True)
    for model in (loaded, custom, problem):
        assert dd.Model(document=model.document).trusted
    assert not dd.Model(document=loaded.document, trusted=False).trusted
    custom.insert(dd.load(stranger.with_name("strange.json")), "theirs")
    assert not dd.Model(document=custom.document).trusted
    custom.undo()
    assert dd.Model(document=custom.document).trusted
