"""The stored runs give every stored claim and every number on the pages."""

from __future__ import annotations

import json
import lzma
import re
from pathlib import Path
from typing import Any

import pytest

from deodar_papers import papers
from tests.deodar_papers.spa.rows import PATH, all_rows
from tests.docs.source import DOCS, ROOT, module

evidence = module(DOCS / "evidence.py")
MADE = {
    "deodar": "0.1.0",
    "jax": "1",
    "jaxlib": "1",
    "numpy": "2",
    "python": "3",
    "device": "cpu",
    "cores": "1",
    "machine": "Linux",
}


@pytest.fixture(scope="module")
def reports() -> dict[str, Any]:
    """Return evidence and report of each paper with stored runs."""
    found = {name: evidence.read(name) for name in evidence.kept()}
    assert set(found) == {file.parent.name for file in evidence.EVIDENCE.rglob("runs.jsonl.xz")} and found
    return {name: (kept, kept.report()) for name, kept in found.items()}


def test_stored_claims_follow_from_the_rows(reports: dict[str, Any]) -> None:
    for name, (kept, report) in reports.items():
        assert same(evidence.EVIDENCE / name / evidence.RESULTS, kept.results(report)), (
            f"evidence/{name} is stale: python tools/generate.py"
        )


def test_the_numbers_on_the_pages_follow_from_the_rows(reports: dict[str, Any]) -> None:
    known = {
        name: evidence.numbers(*reports[name]) if name in reports else evidence.unrun(name)
        for name in papers.PAPERS
    }
    assert evidence.pages()
    for page in evidence.pages():
        text = page.read_text(encoding="utf-8")
        assert evidence.filled(text, known) == text, f"{page.name} is stale: python tools/generate.py"
        assert evidence.loose(text) == [], f"{page.name} states numbers of runs outside of a mark"


def test_without_runs_a_page_states_settings_and_no_results() -> None:
    none = {name: evidence.unrun(name) for name in papers.PAPERS}
    results = [
        value
        for name, value in none["spa"].items()
        if name.startswith(("success:", "ratio:", "arrival:", "weak:", "stuck", "required"))
    ]
    assert len(results) > 100 and set(results) == {evidence.papers.NOT_RUN}
    assert (
        none["spa"]["reflection"] == "0.6" and none["spa"]["factor"] == "1.2" and none["spa"]["runs"] == "0"
    )
    for page in evidence.pages():
        assert evidence.loose(evidence.filled(page.read_text(encoding="utf-8"), none)) == []


def test_evidence_states_versions_and_date_and_no_path(reports: dict[str, Any]) -> None:
    for name, (kept, _) in reports.items():
        assert (
            set(kept.about) - {"earlier"} == {"paper", "command", "quick", "date", "runs", "of", "made_by"}
            and kept.about["paper"] == name
        )
        assert re.fullmatch(r"20\d\d-\d\d-\d\d", kept.about["date"]) and kept.about["runs"] == len(kept.rows)
        assert {"deodar", "jax", "jaxlib", "numpy", "python", "machine"} <= set(kept.about["made_by"])
        assert not re.search(r"/(home|root|tmp|Users|work)\b", json.dumps([kept.about, kept.design]))
        assert sum(p.stat().st_size for p in (evidence.EVIDENCE / name).iterdir()) < 4e6
        design = kept.design[-1]
        assert {k: design[k] for k in design if k != "made_by"} == json.loads(
            json.dumps(papers.PAPERS[name].about(kept.quick))
        ), "the design has changed"


def test_the_wheel_contains_no_evidence() -> None:
    assert evidence.EVIDENCE == ROOT / "evidence" and not list((ROOT / "src").rglob("runs.jsonl*"))


# --------------------------------------------------------------------------------------- on rows made by hand


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return the folder of a reproduction whose rows agree with the paper."""
    spa = papers.PAPERS["spa"]
    first = {"about": {**spa.about(False), "made_by": MADE}}
    text = "".join(
        json.dumps(line) + "\n"
        for line in [first, *all_rows(False, lambda c, k: {"path": PATH[::10]}).values()]
    )
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "runs.jsonl").write_text(text + '{"key": "cut o')
    return tmp_path / "out"


def same(file: Path, text: str) -> bool:
    """Return whether a file contains these results; numbers to four digits, since versions of NumPy differ
    in the last ones.
    """

    def near(a: Any, b: Any) -> bool:
        if isinstance(a, dict) and isinstance(b, dict):
            return a.keys() == b.keys() and all(near(a[k], b[k]) for k in a)
        if isinstance(a, list) and isinstance(b, list):
            return len(a) == len(b) and all(map(near, a, b))
        if isinstance(a, float) and isinstance(b, float):
            return abs(a - b) <= 2e-4 + 1e-6 * abs(a)
        return a == b

    return near(json.loads(file.read_text(encoding="utf-8")), json.loads(text))


def test_a_reproduction_is_stored_and_a_changed_row_is_noticed(folder: Path, tmp_path: Path) -> None:
    taken = evidence.take(folder, tmp_path / "evidence")
    assert len(taken.rows) == taken.about["runs"] == taken.about["of"] and taken.about["made_by"] == MADE
    assert not any("path" in row for row in taken.rows.values() if "planner" not in row["condition"])
    report = taken.report()
    file = tmp_path / "results.json"
    file.write_text(taken.results(report))
    reading = evidence.read("spa", tmp_path / "evidence" / "spa")
    assert same(file, reading.results(reading.report()))
    known = {"spa": evidence.numbers(taken, report)}
    page = (
        "<!-- numbers of spa -->It reaches <!-- evidence spa success:z/planner/low -->?<!-- end --> goals"
        " (figure 7).<!-- end of numbers -->"
    )
    whole = evidence.filled(page, known)
    assert (
        "-->96 of 96<!--" in whole and evidence.filled(whole, known) == whole and evidence.loose(whole) == []
    )
    assert evidence.loose(whole.replace("goals", "goals, 3 of them late")) != []
    for key in ("z/planner/low/000", "z/planner/low/002"):
        reading.rows[key]["success"] = False
    other = reading.report()
    assert not same(file, reading.results(other))
    assert "-->94 of 96<!--" in evidence.filled(whole, {"spa": evidence.numbers(reading, other)})
    with pytest.raises(SystemExit, match="nothing that is called speed"):
        evidence.filled("<!-- evidence spa speed -->3<!-- end -->", known)


def test_conditions_that_a_new_folder_lacks_are_kept_if_their_settings_are_the_present_ones(
    folder: Path, tmp_path: Path
) -> None:
    into, other = tmp_path / "evidence", {**MADE, "machine": "another one"}
    first = evidence.take(folder, into)
    assert first.about["earlier"] == []
    lines = (folder / "runs.jsonl").read_text().splitlines()
    new = [json.loads(line) for line in lines if '"condition": "z/planner/low"' in line]
    about = {"about": {**papers.PAPERS["spa"].about(False), "made_by": other}}
    (folder / "runs.jsonl").write_text("".join(json.dumps(line) + "\n" for line in [about, *new]))
    both = evidence.take(folder, into)
    assert both.rows.keys() == first.rows.keys() and both.about["made_by"] == other
    [earlier] = both.about["earlier"]
    conditions = {key.rpartition("/")[0] for key in first.rows} - {"z/planner/low"}
    assert earlier["made_by"] == MADE and set(earlier["conditions"]) == conditions
    assert "another one" in evidence.numbers(both, both.report())["made"]
    assert evidence.take(folder, into).about["earlier"] == both.about["earlier"]
    # a condition with other settings than the present ones is not kept
    kept = into / "spa" / evidence.ROWS
    text = lzma.decompress(kept.read_bytes()).decode().splitlines()
    old = json.loads(text[0])
    gone = next(iter(conditions & old["about"]["runs"].keys()))
    old["about"]["runs"][gone] = 1
    kept.write_bytes(lzma.compress("\n".join([json.dumps(old), *text[1:]]).encode() + b"\n"))
    taken = evidence.take(folder, into)
    assert {key.rpartition("/")[0] for key in first.rows.keys() - taken.rows.keys()} == {gone}


def test_tables_are_written_between_their_marks(folder: Path, tmp_path: Path) -> None:
    taken = evidence.take(folder, tmp_path / "evidence")
    known = {"spa": evidence.numbers(taken, taken.report())}
    text = evidence.filled("<!-- evidence spa required --><!-- end -->", known)
    assert "\n\n| claim | target |" in text and text.count("| yes |") == 18
    assert evidence.filled(text, known) == text
    assert "| large/reflection-1.0-planner/low | 40 |" in known["spa"]["settings"]
    pages = [page.read_text(encoding="utf-8") for page in evidence.pages()]
    for page in [text for text in pages if "<!-- evidence spa " in text]:
        # complete runs give every name that a page uses
        assert evidence.papers.NOT_RUN not in evidence.filled(page, known)


def test_a_quick_reproduction_is_stored_as_quick(folder: Path, tmp_path: Path) -> None:
    first = {"about": {**papers.PAPERS["spa"].about(True), "made_by": MADE}}
    rows = all_rows(True, lambda c, k: {"path": PATH[::10]}).values()
    (folder / "runs.jsonl").write_text("".join(json.dumps(line) + "\n" for line in [first, *rows]))
    taken = evidence.take(folder, tmp_path / "evidence")
    assert taken.quick and len(taken.rows) == taken.about["of"] < 2000
    numbers = evidence.numbers(taken, taken.report())
    assert (
        numbers["command"] == "`deodar reproduce spa --quick`"
        and numbers["success:z/planner/low"] == "20 of 20"
    )
    assert json.loads(taken.results(taken.report()))["settings"]["quick"] is True


def test_a_condition_that_is_not_complete_is_left_out(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = folder / "runs.jsonl"
    lines = file.read_text().splitlines()
    last = json.loads(lines[-2])["condition"]  # the last line is torn
    file.write_text("".join(line + "\n" for line in lines[:-2]))
    taken = evidence.take(folder, tmp_path / "evidence")
    assert last in capsys.readouterr().err
    numbers = evidence.numbers(taken, taken.report())
    assert numbers["missing"] == last and numbers[f"success:{last}"] == evidence.papers.NOT_RUN
    assert {row["condition"] for row in taken.rows.values()} == {
        json.loads(line)["condition"] for line in lines[1:-1]
    } - {last}
    assert taken.about["runs"] == len(taken.rows) < taken.about["of"]


def test_a_reproduction_without_a_complete_condition_is_not_stored(folder: Path, tmp_path: Path) -> None:
    file = folder / "runs.jsonl"
    file.write_text("".join(line + "\n" for line in file.read_text().splitlines()[:3]))
    with pytest.raises(SystemExit, match=r"no condition is complete.*deodar reproduce spa --out"):
        evidence.take(folder, tmp_path / "evidence")
    assert not (tmp_path / "evidence").exists()


def test_a_reproduction_of_another_design_is_not_stored(folder: Path, tmp_path: Path) -> None:
    file = folder / "runs.jsonl"
    file.write_text(file.read_text().replace('"limit": 3000', '"limit": 2000', 1))
    with pytest.raises(SystemExit, match="not the whole design of spa"):
        evidence.take(folder, tmp_path / "evidence")
