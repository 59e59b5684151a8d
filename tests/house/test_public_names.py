"""Public names: the root's list, the cost of importing them, and errors of unknown names."""

from __future__ import annotations

import inspect
import json
import subprocess
import sys
from collections.abc import Callable, Iterator

import pytest

import deodar
from deodar import registry
from deodar.experiments import actions, events
from tests.house.source import ENGINE, ROOT

sys.path.insert(0, str(ROOT / "tools"))
import stub

HEAVY = ["jax", "jaxlib", "numpy", "scipy", "xarray", "zarr", "matplotlib", "PIL", "rich", "psutil"]
SLOW = ["scipy.stats", "scipy.optimize", "matplotlib", "PIL"]


def _loaded(code: str, packages: list[str] = HEAVY) -> set[str]:
    """Return the heavy packages that a new process has imported after running `code`."""
    tail = f"\nimport sys, json; print('LOADED', json.dumps([m for m in {packages!r} if m in sys.modules]))"
    done = subprocess.run([sys.executable, "-c", code + tail], capture_output=True, text=True, check=True)
    line = next(line for line in done.stdout.splitlines() if line.startswith("LOADED"))
    return set(json.loads(line.removeprefix("LOADED ")))


def test_every_name_resolves_and_has_a_docstring() -> None:
    """`help` shows the name that a script has, but for aliases of types."""
    public = {name: getattr(deodar, name) for name in deodar.__all__}
    shown = {name: getattr(member, "__name__", name).rpartition(".")[2] for name, member in public.items()}
    assert not [name for name, member in public.items() if not member.__doc__ or name not in dir(deodar)]
    assert not {name: other for name, other in shown.items() if other not in (name, "tuple", "dict")}


def test_the_stub_is_up_to_date() -> None:
    text = (ENGINE / "__init__.pyi").read_text(encoding="utf-8")
    assert stub.stub(text) == text, "type: python tools/generate.py"


def test_the_list_of_figures_is_up_to_date_and_a_missing_kind_is_added() -> None:
    text = stub.FIGURES.read_text(encoding="utf-8")
    assert stub.figures(text) == text, "type: python tools/generate.py"
    line = "from deodar.figures.space_time import space_time\n"
    assert stub.figures(text.replace(line, "").replace('    "space_time",\n', "")) == text


def test_kinds_and_names_of_packages_are_added_to_a_stub_and_old_ones_removed() -> None:
    lines = stub.stub(
        "from deodar.elements.gone import Field as Field\nfrom deodar.batch import late as late\n"
    )
    assert "elements.gone" not in lines and "from deodar.elements.field import Field as Field\n" in lines
    assert "from deodar.batch import late as late\n" in lines


def test_every_kind_of_deodar_is_a_public_name() -> None:
    kinds = {name: cls for name, cls in registry.kinds().items() if registry.own(cls)}
    assert not kinds.keys() - set(deodar.__all__), "type: python tools/generate.py"
    assert all(getattr(deodar, name) is cls for name, cls in kinds.items())


@pytest.mark.parametrize("module", [actions, events], ids=["actions", "events"])
def test_every_experiment_part_is_a_public_name(module: object) -> None:
    parts = [
        n
        for n, v in vars(module).items()
        if isinstance(v, type) and issubclass(v, (actions.Action, events.Event)) and not n.startswith("_")
    ]
    assert len(parts) > 5 and set(parts) <= set(deodar.__all__)


@pytest.mark.parametrize("package", ["analysis", "figures"])
def test_every_function_of_measuring_and_drawing_is_a_public_name(package: str) -> None:
    public = getattr(deodar, package).__all__
    assert {name for name in public if name.islower()} <= set(deodar.__all__)


@pytest.mark.parametrize("package", ["analysis", "architectures", "figures"])
def test_a_function_wins_over_the_file_of_its_name(package: str) -> None:
    member = getattr(deodar, package)
    assert all(not isinstance(getattr(member, name), type(sys)) for name in member.__all__)


def test_a_star_import_gives_the_public_names() -> None:
    names: dict[str, object] = {}
    exec("from deodar import *", names)
    assert set(deodar.__all__) <= set(names)


def test_an_unknown_name_of_the_root_suggests_the_nearest() -> None:
    with pytest.raises(
        AttributeError, match=r"^module 'deodar' has no attribute 'Feild'. Did you mean 'Field'\?$"
    ):
        deodar.Feild  # noqa: B018


def test_an_unknown_private_name_suggests_nothing() -> None:
    with pytest.raises(AttributeError, match=r"^module 'deodar' has no attribute '__wrapped__'$"):
        deodar.__wrapped__  # noqa: B018


@pytest.mark.parametrize(
    "call",
    [deodar.Model.add, deodar.animate_path, deodar.Model.set_ticks],
    ids=["add", "animate_path", "set_ticks"],
)
def test_calls_that_count_ticks_have_no_argument_every(call: Callable[..., object]) -> None:
    assert (
        "every" not in inspect.signature(call).parameters
        and {"ticks", "stride"} & inspect.signature(call).parameters.keys()
    )


def _public_calls() -> Iterator[Callable[..., object]]:
    for member in (getattr(deodar, name) for name in deodar.__all__):
        for call in (member, *(vars(member).values() if isinstance(member, type) else ())):
            if inspect.isfunction(call) or isinstance(call, type):
                yield call


def test_every_is_a_time_in_every_public_call() -> None:
    """A time may be a fraction and defaults to the step; a count is an `int` that defaults to 1."""
    given = {call: inspect.signature(call).parameters.get("every") for call in _public_calls()}
    times = {call: every for call, every in given.items() if every is not None}
    wrong = [
        c for c, every in times.items() if every.default is not None or "float" not in str(every.annotation)
    ]
    assert len(times) > 5 and not wrong, wrong


def test_an_unknown_attribute_of_a_model_raises_an_error_of_python() -> None:
    with pytest.raises(AttributeError, match=r"^'Model' object has no attribute 'chnge'$"):
        deodar.Model("m").chnge  # noqa: B018


def test_importing_deodar_imports_nothing_heavy() -> None:
    assert _loaded("import deodar") == set()


def test_a_wrong_name_imports_nothing_heavy() -> None:
    assert _loaded("import deodar\nassert not hasattr(deodar, 'Feild')") == set()


def test_errors_and_the_command_line_import_nothing_heavy() -> None:
    assert _loaded("import deodar; deodar.errors.DeodarError") == set()
    assert _loaded("import deodar.cli; deodar.cli.parser().format_help()") == set()


def test_help_answers_without_jax_and_numpy() -> None:
    code = (
        "import contextlib, deodar.cli\nwith contextlib.suppress(SystemExit):\n   "
        " deodar.cli.main(['--help'])\n"
    )
    assert _loaded(code) == set()


def test_a_document_is_read_and_checked_without_plots_or_records() -> None:
    """Reading and checking is quick, because xarray, Zarr and matplotlib are imported when a record is
    made or drawn.
    """
    code = (
        "import deodar as dd; m = dd.Model('m'); m.add(dd.Field('u', [dd.Axis('x', 0, 1, samples=3)]));"
        " assert not m.check()"
    )
    assert not _loaded(code) & {"xarray", "zarr", "matplotlib", "PIL", "rich"}


def test_the_studio_starts_without_what_it_needs_later() -> None:
    assert _loaded("import deodar_studio.web.serve", SLOW) == set()
