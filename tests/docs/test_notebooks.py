"""Notebooks in a real kernel: the page about them, word for word, and the exercises with their solutions."""

from __future__ import annotations

import os
import re
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

from deodar.model import written
from tests.docs.source import DOCS, ROOT

EXERCISES = ROOT / "examples" / "exercises"
NAMES = sorted(path.stem for path in EXERCISES.glob("*.ipynb"))
CELL = re.compile(r"^```(?:python|ipython)\n(.*?)^```$", re.MULTILINE | re.DOTALL)

pytestmark = pytest.mark.filterwarnings("ignore")  # of the libraries between this process and the kernel


def execute(notebook: nbformat.NotebookNode, folder: Path) -> list[nbformat.NotebookNode]:
    """Run a notebook in a kernel, cells after one that fails, too; return its cells of code."""
    environment = {
        **os.environ,
        written.STATES: str(folder / "states"),
        "JPY_SESSION_NAME": str(folder / "notebook.ipynb"),
        "IPYTHONDIR": str(folder / "ipython"),
    }
    client = NotebookClient(notebook, timeout=300, kernel_name="python3", allow_errors=True)
    client.execute(cwd=str(folder), env=environment)
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def of_cells(*sources: str) -> nbformat.NotebookNode:
    """Return a notebook of cells of code."""
    return nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(source) for source in sources])


def printed(cell: nbformat.NotebookNode) -> str:
    """Return the text that a cell has printed."""
    return "".join(output.get("text", "") for output in cell.outputs)


def representations(cell: nbformat.NotebookNode) -> list[dict[str, str]]:
    """Return the representations that a cell shows."""
    return [output["data"] for output in cell.outputs if "data" in output]


def test_the_page_does_in_a_kernel_what_it_says(tmp_path: Path) -> None:
    sources = CELL.findall((DOCS / "notebooks.md").read_text(encoding="utf-8"))
    figure_again = "import matplotlib.pyplot\ndd.space_time(record['u.activation'])"
    extra = ["record", "dd.simulate(model, 4000, on=dd.Resources(progress=True))", figure_again, "result"]
    cells = execute(of_cells(*sources, *extra), tmp_path)
    by = {cell.source.split("\n")[0]: cell for cell in cells}
    errors = [cell for cell in cells if any(o.output_type == "error" for o in cell.outputs)]
    assert [cell.source.strip() for cell in errors] == ['dd.simulate(model, 10, record=["u.activaton"])']
    lines = "\n".join(errors[0].outputs[0].traceback).split("\n")
    assert len(lines) < 12 and lines[0] == "Cell, line 1" and "DEODAR_TRACEBACK=full" in lines[-1]
    models = representations(by["import deodar as dd"])
    assert len(models) == 1 and "<svg" in models[0]["text/html"]
    figures = [cell for cell in cells if cell.source.startswith("record = dd.simulate")]
    assert [list(representations(cell)[0]) for cell in figures] == [["text/plain", "image/png"]]
    assert len(representations(cells[-2])) == 1 and "image/png" in representations(cells[-2])[0], (
        "once, also with pyplot"
    )
    assert "regimes: thresholds" in printed(
        by['result = dd.regimes(model, "u", on=dd.Resources(progress=print))']
    )
    live = representations(by["import matplotlib.pyplot as plt"])
    assert "image/png" in live[0] and "times real time" in live[-1]["text/html"]
    assert "steps" in printed(cells[-3]), "a bar"
    for cell in cells:
        for markup in representations(cell):
            assert len(markup.get("text/html", "")) < 20_000 and "<style" not in markup.get("text/html", "")


def test_cells_run_again_in_a_new_kernel_of_the_same_notebook(tmp_path: Path) -> None:
    source = "import deodar as dd\nm = dd.Model('m')\nm.add(dd.Field('u', []))\ndd.save(m, 'm.json')"
    for _ in range(2):
        cells = execute(of_cells(source, source), tmp_path)
        assert not any(output.output_type == "error" for cell in cells for output in cell.outputs)


def exercise(name: str) -> nbformat.NotebookNode:
    """Return the notebook of an exercise."""
    return nbformat.read(EXERCISES / f"{name}.ipynb", as_version=4)


def solutions(name: str) -> dict[str, str]:
    """Return the cell of each task."""
    text = (EXERCISES / "solutions" / f"{name}.py").read_text(encoding="utf-8")
    parts = re.split(r"^# (task \d+)\n", text, flags=re.MULTILINE)[1:]
    return {tag.replace(" ", "-"): cell for tag, cell in zip(parts[::2], parts[1::2], strict=True)}


def verdicts(cells: list[nbformat.NotebookNode]) -> list[str]:
    """Return what the checks say."""
    texts = [printed(cell) for cell in cells]
    return [line for text in texts for line in text.splitlines() if line.startswith(("Right", "Not yet"))]


@pytest.mark.parametrize("name", NAMES)
def test_a_solved_exercise_passes_its_checks(name: str, tmp_path: Path) -> None:
    notebook, solved = exercise(name), solutions(name)
    tasks = [cell for cell in notebook.cells if cell.metadata.get("tags")]
    assert {cell.metadata.tags[0] for cell in tasks} == set(solved)
    for cell in tasks:
        cell.source = solved[cell.metadata.tags[0]]
    cells = execute(notebook, tmp_path)
    assert not any(output.output_type == "error" for cell in cells for output in cell.outputs)
    assert verdicts(cells) == ["Right."] * len(solved)


def test_an_exercise_without_answers_says_not_yet(tmp_path: Path) -> None:
    cells = execute(exercise("forgetting"), tmp_path)
    assert not any(output.output_type == "error" for cell in cells for output in cell.outputs)
    assert [text.startswith("Not yet: ") for text in verdicts(cells)] == [True, True]


def test_the_exercises_are_small_and_hold_no_outputs() -> None:
    assert NAMES == ["detection", "forgetting", "memory", "selection"]
    for name in NAMES:
        assert (EXERCISES / f"{name}.ipynb").stat().st_size < 8000
        cells = [cell for cell in exercise(name).cells if cell.cell_type == "code"]
        assert not any(cell.outputs or cell.execution_count for cell in cells)
