"""Messages of errors: the problem, its place, and the fix."""

from __future__ import annotations

import pickle

import pytest

from deodar import errors
from deodar.errors import DeodarError, Interrupted, MissingExtra, Problem, did_you_mean

KINDS = [e for e in vars(errors).values() if isinstance(e, type) and issubclass(e, DeodarError)]


def test_what_where_and_fix_are_one_paragraph() -> None:
    error = errors.ParameterError(
        "is -1, below its lower bound 0", where="u.noise", fix="Take a number above 0"
    )
    assert str(error) == "u.noise: is -1, below its lower bound 0. Take a number above 0"
    assert error.problems == (Problem("u.noise", "is -1, below its lower bound 0", "Take a number above 0"),)


def test_several_problems_are_numbered() -> None:
    error = errors.ModelError([Problem("u", "one"), Problem("v", "two", "Type this")])
    assert str(error) == "2 problems\n  1. u: one\n  2. v: two. Type this"


def test_a_fix_is_that_of_the_place_where_it_is_read() -> None:
    fix = errors.Fix("Replace it: force=True", "Replace it: --force", "Choose another name")
    error = errors.OutputExists("exists", where="a.nc", fix=fix)
    error.advise("Or remove it")
    copy = pickle.loads(pickle.dumps(error))
    assert str(copy) == copy.at("script") == "a.nc: exists. Replace it: force=True. Or remove it"
    assert copy.at("shell") == "a.nc: exists. Replace it: --force. Or remove it"
    assert copy.at("page") == "a.nc: exists. Choose another name. Or remove it"
    assert {type(fix.at(place)) for place in ("script", "shell", "page")} == {str}
    two = errors.ModelError([Problem("u", "one", fix), Problem("v", "two", "Type this")])
    assert two.at("shell") == "2 problems\n  1. u: one. Replace it: --force\n  2. v: two. Type this"


def test_an_option_is_an_argument_in_a_script() -> None:
    trust = errors.option("Trust it:", "trust_network", "", "True", page="the box Trust")
    assert [trust.at(place) for place in ("script", "shell", "page")] == [
        "Trust it: trust_network=True",
        "Trust it: --trust-network",
        "Trust it: the box Trust",
    ]
    assert errors.option("One above 0:", "trials", "100").at("page") == "One above 0: trials=100"


def test_a_single_problem_is_not_numbered() -> None:
    assert str(errors.ModelError([Problem("u", "one")])) == "u: one"


@pytest.mark.parametrize(
    ("name", "names", "hint"),
    [
        ("restng_level", ["tau", "resting_level"], "Did you mean 'resting_level'?"),
        ("zzz", ["tau", "noise"], "Valid names: noise, tau"),
        ("zzz", [], ""),
        (
            "zzz",
            [f"name{i:02}" for i in range(30)],
            "Valid names: " + ", ".join(f"name{i:02}" for i in range(12)) + ", ...",
        ),
    ],
)
def test_the_nearest_name_is_suggested(name: str, names: list[str], hint: str) -> None:
    assert did_you_mean(name, names) == hint


def test_a_missing_extra_names_the_package_to_install() -> None:
    error = MissingExtra("cv2", "vision", "the camera")
    assert (
        str(error)
        == "the camera needs the package cv2, which is not installed. Type: pip install 'deodar[vision]'"
    )


def test_an_interrupted_run_has_its_data() -> None:
    stranger = object()
    error = Interrupted("stopped at 5 of 10 ms", stranger)
    assert error.data is stranger and str(error) == "stopped at 5 of 10 ms"


def test_an_interrupted_run_stops_a_loop_that_continues_after_errors() -> None:
    begun = []
    with pytest.raises(KeyboardInterrupt):
        for k in range(3):
            try:
                begun.append(k)
                raise Interrupted("stopped", None)
            except Exception:
                continue
    assert begun == [0]


def test_every_error_documents_when_it_is_raised() -> None:
    silent = [e.__name__ for e in KINDS if "aised" not in (e.__doc__ or "") and e is not DeodarError]
    assert len(KINDS) > 20 and not silent, silent


def test_errors_are_passed_between_processes() -> None:
    for kind in {*KINDS} - {MissingExtra}:
        error = kind([Problem("u", "one"), Problem("v", "two")])
        copied = pickle.loads(pickle.dumps(error))
        assert type(copied) is kind and str(copied) == str(error)


def test_a_message_with_a_name_of_a_damaged_file_is_shortened() -> None:
    error = errors.DocumentError(f"no kind is called {'Logistic' * 200_000!r}", where="u" * 10_000, fix="x")
    (problem,) = error.problems
    assert problem.what.startswith("no kind is called 'Logistic") and problem.what.endswith("Logistic'")
    assert len(problem.what) == len(problem.where) == errors.LONGEST + len(" ... ")
    assert len(str(error)) < 2.1 * errors.LONGEST
