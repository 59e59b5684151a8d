"""The runs behind the numbers of the manual: kept in `evidence/`, a folder for each paper, and every number
on a page that comes from them.

    python docs/evidence.py FOLDER     take the complete conditions in the folder of a
                                       `deodar reproduce PAPER [--quick]`, keep the stored ones that it
                                       lacks if their settings are the present ones, then write everything
    python docs/evidence.py            write claims and pages from the stored runs
    python docs/evidence.py --print    print every number and table by its name

A folder of evidence holds `about.json` (versions, machine, date, command), `runs.jsonl.xz` (a row for each
run) and `results.json` (the claims). On a page a comment names a number or table of a paper, and what lies
between it and the next `<!-- end -->` is written from the rows:

    reaches <!-- evidence spa success:z/planner/low -->96 of 96<!-- end --> goals
"""

from __future__ import annotations

import datetime
import json
import lzma
import re
import sys
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import deodar as dd
from deodar_papers import papers

DOCS = Path(__file__).parent
ROOT = DOCS.parent
EVIDENCE = ROOT / "evidence"
DOTS = 100
"""Dots an inch of the pictures on pages; those that `deodar reproduce` writes have those of print."""

ABOUT, ROWS, RESULTS = "about.json", "runs.jsonl.xz", "results.json"
PLACE = re.compile(r"<!-- evidence ([\w-]+) (\S+) -->(.*?)<!-- end -->", re.DOTALL)
REGION = re.compile(r"<!-- numbers of ([\w-]+) -->(.*?)<!-- end of numbers -->", re.DOTALL)
NAMED = re.compile(
    r"!?\[[^\]]*\]\([^)]*\)|`[^`]*`|\(\d{4}\)|(?:figures?|sections?|tables?|eqs?\.|equations?|cases?)"
    r" \d[\d.]*(?:(?:, | to | and )\d[\d.]*)*|95 %"
)
"""What may stand outside of a mark: links and pictures, code, years, places in a paper, and the level of all
intervals.
"""


@dataclass(frozen=True)
class Evidence:
    """The runs of a paper as they are kept.

    Attributes:
        paper: its name.
        about: versions, machine, date and command.
        design: what makes the experiment: the first lines of the rows, the last one holds for all of them.
        rows: by their keys.
    """

    paper: str
    about: Mapping[str, Any]
    design: Sequence[Mapping[str, Any]]
    rows: Mapping[str, Mapping[str, Any]]

    def report(self) -> papers.Report:
        """Claims, figures, tables and numbers of the rows."""
        return papers.PAPERS[self.paper].report(self.rows, self.quick)

    def results(self, report: papers.Report) -> str:
        """The content of `results.json`."""
        return dd.analysis.claims.results(
            report.claims,
            {"paper": self.paper, "quick": self.quick, "runs": len(self.rows), "of": self.about["of"]},
        )

    @property
    def quick(self) -> bool:
        """Whether they are the runs of `--quick`."""
        return bool(self.about["quick"])


def kept() -> list[str]:
    """The papers whose runs are kept."""
    return sorted(rows.parent.name for rows in EVIDENCE.glob(f"*/{ROWS}"))


def read(paper: str, folder: Path | None = None) -> Evidence:
    """The runs of a paper that are kept; `folder`: another one than that of the repository."""
    at = folder or EVIDENCE / paper
    about = json.loads((at / ABOUT).read_text(encoding="utf-8"))
    lines = [json.loads(line) for line in lzma.decompress((at / ROWS).read_bytes()).splitlines()]
    return Evidence(
        paper,
        about,
        [line["about"] for line in lines if "key" not in line],
        {line["key"]: line for line in lines if "key" in line},
    )


def take(source: Path, into: Path = EVIDENCE) -> Evidence:
    """Take the folder of a reproduction: its rows without what nothing reads, and what made them."""
    text = (source / "runs.jsonl").read_text(encoding="utf-8")
    lines = [json.loads(line) for line in text[: text.rfind("\n") + 1].splitlines()]
    made = [line["about"] for line in lines if "key" not in line][-1]
    name = made["paper"]
    paper = papers.PAPERS[name]
    quick = bool(made["quick"])
    command = f"deodar reproduce {name}" + (" --quick" if quick else "")
    if any(made.get(k) != v for k, v in json.loads(json.dumps(paper.about(quick))).items()):
        sys.exit(
            f"{source}: not the whole design of {name}, or another one; run {command} into a new folder first"
        )
    keys = {key for job in paper.jobs(quick) for key in job.keys}
    found = {line["key"]: paper.kept(line) for line in lines if "key" in line}
    unfinished = _unfinished(keys, found)
    rows = [row for key, row in found.items() if key in keys and _condition(key) not in unfinished]
    if not rows:
        sys.exit(f"{source}: no condition is complete; run {command} --out {source} first")
    if unfinished:
        sys.stderr.write(
            f"{source}: not complete, and left out: {', '.join(unfinished)}. To resume: {command} --out"
            f" {source}\n"
        )
    date = datetime.datetime.fromtimestamp((source / "runs.jsonl").stat().st_mtime, datetime.UTC).date()
    folder = into / name
    earlier, others = _earlier(folder, json.loads(json.dumps(paper.about(quick))), paper.BY_CONDITION, rows)
    rows += others
    about = {
        "paper": name,
        "command": command,
        "quick": quick,
        "date": str(date),
        "runs": len(rows),
        "of": len(keys),
        "made_by": made["made_by"],
        "earlier": earlier,
    }
    folder.mkdir(parents=True, exist_ok=True)
    content = "".join(
        json.dumps(line) + "\n" for line in [*(line for line in lines if "key" not in line), *rows]
    )
    (folder / ROWS).write_bytes(lzma.compress(content.encode(), preset=9))
    (folder / ABOUT).write_text(json.dumps(about, indent=2) + "\n", encoding="utf-8")
    return read(name, folder)


def _earlier(
    folder: Path, design: Mapping[str, Any], by_condition: Sequence[str], rows: Sequence[Mapping[str, Any]]
) -> tuple[list[dict[str, Any]], list[Mapping[str, Any]]]:
    """Return what made the stored conditions that new rows lack, and the rows of these conditions; only of
    those whose settings are the present ones.
    """
    if not (folder / ROWS).exists():
        return [], []
    stored = read(folder.name, folder)
    if stored.quick != design["quick"]:
        return [], []
    new = {_condition(row["key"]) for row in rows}
    made = stored.design[-1]
    kept = [c for c in dict.fromkeys(map(_condition, stored.rows)) if c not in new]

    def settings(design: Mapping[str, Any], condition: str) -> list[Any]:
        return [design[k].get(condition) for k in by_condition]

    same = [c for c in kept if any(settings(made, c)) and settings(made, c) == settings(design, c)]
    before = [
        {**entry, "conditions": [c for c in entry["conditions"] if c in same]}
        for entry in stored.about.get("earlier", ())
    ]
    known = {c for entry in before for c in entry["conditions"]}
    last = [c for c in same if c not in known]
    about = {"made_by": stored.about["made_by"], "date": stored.about["date"], "conditions": last}
    made_them = [entry for entry in [*before, about] if entry["conditions"]]
    return made_them, [row for key, row in stored.rows.items() if _condition(key) in same]


def _condition(key: str) -> str:
    """The condition of a run. Only whole conditions are stored, so that runs cannot be selected."""
    return key.rsplit("/", 1)[0]


def _unfinished(keys: Collection[str], found: Collection[str]) -> list[str]:
    """The conditions of which runs are missing, in order."""
    return sorted({_condition(key) for key in keys if key not in found})


def numbers(evidence: Evidence, report: papers.Report) -> dict[str, str]:
    """What a page may say, by name: the numbers of the paper, and of its claims and runs."""
    required = [c for c in report.claims if c.kind == "required"]
    told = [c for c in report.claims if c.kind == "reported"]
    return {
        **report.numbers,
        "required": _table(required),
        "contradicted": _table([c for c in told if c.holds is False]),
        "undecided": _table([c for c in report.claims if c.holds is None and c.origin != "none"]),
        "inferred": _table([c for c in told if c.inferred]),
        "required-count": _counted("required claims", required),
        "reported-count": _counted("reported sentences", told),
        "missing": _missing(evidence),
        "command": f"`{evidence.about['command']}`",
        "made": "; ".join([_made(evidence.about), *map(_made, evidence.about.get("earlier", ()))]),
    }


def _made(about: Mapping[str, Any]) -> str:
    """Versions, machine and date of runs; of some conditions alone, with their names."""
    made = about["made_by"]
    versions = f"deodar {made['deodar']}, JAX {made['jax']}, NumPy {made['numpy']}, Python {made['python']}"
    names = f"{', '.join(about['conditions'])}: " if "conditions" in about else ""
    return f"{names}{versions}, {made['machine']}, {about['date']}"


def _missing(evidence: Evidence) -> str:
    """The conditions of which no runs are kept."""
    keys = {key for job in papers.PAPERS[evidence.paper].jobs(evidence.quick) for key in job.keys}
    return ", ".join(_unfinished(keys, evidence.rows)) or "none"


def unrun(paper: str) -> dict[str, str]:
    """What a page may say of a paper whose runs are not kept: its settings, and in the place of every other
    number that nothing was run.
    """
    names = (
        "required",
        "contradicted",
        "undecided",
        "inferred",
        "required-count",
        "reported-count",
        "made",
        "command",
        "missing",
    )
    return {**papers.PAPERS[paper].report({}, False).numbers, **dict.fromkeys(names, papers.NOT_RUN)}


def _counted(what: str, claims: Sequence[dd.analysis.claims.Claim]) -> str:
    """How many hold, fail, and are undecided."""
    hold, fail = (sum(c.holds is verdict for c in claims) for verdict in (True, False))
    untold = sum(c.origin == "none" for c in claims)
    target = f", {untold} have no target" if untold else ""
    return (
        f"{len(claims)} {what} {hold} hold, {fail} fail, {len(claims) - hold - fail - untold} are"
        f" undecided{target}"
    )


def _table(claims: Sequence[dd.analysis.claims.Claim]) -> str:
    """Claims as Markdown."""
    lines = ["| claim | target | from | value | 95 % interval | n | holds |", "|---|---|---|---|---|---|---|"]
    for c in claims:
        interval = "" if c.interval is None else f"{c.interval[0]:g} to {c.interval[1]:g}"
        holds = {True: "yes", False: "no", None: "open"}[c.holds]
        value = "" if c.value is None else f"{c.value:g}" if isinstance(c.value, float) else str(c.value)
        target = str(c.target).replace("|", " ")
        lines.append(f"| {c.name} | {target} | {c.origin} | {value} | {interval} | {c.n} | {holds} |")
    return "\n".join(lines) + "\n"


def pages() -> list[Path]:
    """Every page that has a place for a number."""
    return [
        p
        for p in (ROOT / "README.md", *sorted(DOCS.glob("*.md")))
        if PLACE.search(p.read_text(encoding="utf-8"))
    ]


def filled(text: str, known: Mapping[str, Mapping[str, str]]) -> str:
    """The text of a page with every number as the runs have it; a name that they do not give is an error."""

    def put(found: re.Match[str]) -> str:
        paper, name, _ = found.groups()
        if name not in known.get(paper, {}):
            sys.exit(
                f"the runs of {paper} give nothing that is called {name}: see python docs/evidence.py --print"
            )
        value = known[paper][name]
        block = "\n" in value
        return (
            f"<!-- evidence {paper} {name} -->{chr(10) * 2 + value + chr(10) if block else value}<!-- end -->"
        )

    return PLACE.sub(put, text)


def loose(text: str) -> list[str]:
    """Numbers in a region of results that no run gives: each of them would have to be kept right by hand."""
    out: list[str] = []
    for region in REGION.finditer(text):
        prose = re.sub(r"^```.*?^```$", "", PLACE.sub("", region[2]), flags=re.MULTILINE | re.DOTALL)
        out += [line for line in NAMED.sub("", prose).splitlines() if re.search(r"\d", line)]
    return out


def write(evidence: Evidence, pictures: bool) -> dict[str, str]:
    """Write claims and pictures; return the numbers for the pages."""
    report = evidence.report()
    (EVIDENCE / evidence.paper / RESULTS).write_text(evidence.results(report), encoding="utf-8")
    for picture, figure in papers.PAPERS[evidence.paper].PICTURES.items() if pictures else ():
        if figure in report.figures:
            dd.figures.save_figure(
                report.figures[figure], DOCS / "pictures" / f"{picture}.png", force=True, dots=DOTS
            )
    return numbers(evidence, report)


def main() -> int:
    """Status 0."""
    words = [word for word in sys.argv[1:] if not word.startswith("-")]
    taken = [take(Path(word)).paper for word in words]
    known = {
        paper: write(read(paper), paper in taken) if paper in kept() else unrun(paper)
        for paper in papers.PAPERS
    }
    if "--print" in sys.argv[1:]:
        for paper, found in known.items():
            sys.stdout.writelines(
                f"{paper} {name}: {chr(10) if chr(10) in value else ''}{value}\n"
                for name, value in found.items()
            )
    for page in pages():
        page.write_text(filled(page.read_text(encoding="utf-8"), known), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
