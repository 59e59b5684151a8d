"""Examples on the command line: listed, copied, opened, and accepted by name in place of a file."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import deodar as dd
from deodar import cli
from deodar.cli import main
from deodar.importers import examples
from deodar.recording import files


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def told(capsys: pytest.CaptureFixture[str]) -> str:
    """Return the output, on one line."""
    captured = capsys.readouterr()
    return " ".join((captured.out + captured.err).split())


def test_examples_are_listed_with_a_sentence(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["examples"]) == 0
    out = told(capsys)
    for name in [*examples.names(), *examples.scripts()]:
        assert name in out and examples.sentence(name) in out
    assert "deodar run example:" in out and "deodar examples copy" in out


def test_the_list_as_json_names_every_example(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["examples", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)["examples"]
    assert [e["name"] for e in listed] == [*examples.names(), *examples.scripts()]
    selection = next(e for e in listed if e["name"] == "selection")
    assert (
        selection["kind"] == "document" and selection["duration"] == 600 and Path(selection["file"]).is_file()
    )
    assert {e["kind"] for e in listed} == {"document", "script"}


def test_every_example_has_a_sentence() -> None:
    says = {name: examples.sentence(name) for name in (*examples.names(), *examples.scripts())}
    assert says and not {name: s for name, s in says.items() if not 20 < len(s) <= examples.LONGEST}


def test_the_script_that_writes_the_examples_is_not_an_example() -> None:
    assert not {"make", "pictures"} & set(examples.scripts())


def test_a_document_is_copied_with_its_arrays(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["examples", "copy", "spa"]) == 0
    assert sorted(p.suffix for p in folder.iterdir()) == [".json", ".npz"]
    assert dd.load("spa.json").document == dd.load("example:spa").document
    assert "deodar studio spa.json" in told(capsys)


def test_a_script_is_copied_with_the_documents_it_reads(folder: Path) -> None:
    assert main(["examples", "copy", "choices", "mine"]) == 0
    assert sorted(p.name for p in (folder / "mine").iterdir()) == ["choices.py", "selection.json"]


def test_a_second_example_is_copied_into_the_same_folder(folder: Path) -> None:
    assert main(["examples", "copy", "selection", "mine"]) == 0
    assert main(["examples", "copy", "spa", "mine"]) == 0
    assert sorted(p.suffix for p in (folder / "mine").iterdir()) == [".json", ".json", ".npz"]
    assert dd.load(folder / "mine" / "spa.json").document == dd.load("example:spa").document


def test_a_copy_does_not_replace_an_existing_file(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "spa.json").write_text("mine")
    assert main(["examples", "copy", "spa"]) == 1
    assert "exists already" in told(capsys) and [p.name for p in folder.iterdir()] == ["spa.json"]
    assert main(["examples", "copy", "spa", "--force", "--json"]) == 0
    assert len(json.loads(capsys.readouterr().out)["files"]) == 2 and dd.load("spa.json").name


@pytest.mark.parametrize(
    ("words", "status", "says"),
    [
        (["examples", "copy"], 2, "needs the NAME of an example"),
        (["examples", "copy", "selektion"], 1, "Did you mean 'selection'?"),
        (["examples", "open", "choices"], 1, "is a script"),
        (["examples", "show"], 2, "copy"),
        (["check", "example:selektion"], 2, "Did you mean 'selection'?"),
        (["check", "example:"], 2, "deodar examples"),
        (["run", "selection"], 1, "there is no such file. Did you mean 'example:selection'?"),
        (
            ["run", "selection.json", "--duration", "5"],
            1,
            "there is no such file. Did you mean 'example:selection'?",
        ),
        (["run", "selektion"], 1, "there is no such file. Did you mean 'example:selection'?"),
        (["check", "selection"], 1, "there is no such file. Did you mean 'example:selection'?"),
    ],
)
def test_an_unknown_example_is_an_error_that_states_what_to_type(
    words: list[str], status: int, says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    try:
        found = main(words)
    except SystemExit as stopped:
        found = int(stopped.code or 0)
    assert (found, says in told(capsys)) == (status, True)


def test_a_file_of_the_folder_is_suggested_before_an_example(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    dd.save(dd.Model("m"), folder / "selections.json")
    assert main(["run", "selektions.json", "--duration", "5"]) == 1
    assert "Did you mean 'selections.json'?" in told(capsys)


def test_an_example_runs_for_the_duration_in_its_notes(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", "example:selection", "--every", "100", "--record", "u.activation", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["out"] == "selection-001"
    assert float(files.load_record(folder / "selection-001")["time"][-1]) == 600
    assert main(["run", "example:selection", "--duration", "20", "--out", "short"]) == 0


@pytest.mark.parametrize(
    "words",
    [["check", "example:node"], ["run", "example:node", "--duration", "5", "--live", "--speed", "max"]],
)
def test_an_example_can_be_named_instead_of_a_file(words: list[str]) -> None:
    assert main(words) == 0


@pytest.mark.parametrize("command", ["check", "run", "regimes", "import", "pack"])
def test_every_command_with_a_model_accepts_names_of_examples(command: str) -> None:
    """They share one type of argument, which agrees with `load` of scripts."""
    from deodar.cli import _options

    parser = _options.CommandParser()
    cli.COMMANDS[command].arguments(parser)
    assert next(a for a in parser._actions if a.dest == "file").type is _options.document
    assert _options.document("example:node") == examples.file("node")
