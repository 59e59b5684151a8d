"""Attacks the studio and prints what became of it: `python benchmarks/attacks.py
[edits|undo|documents|messages|kills|records|bits|formats|soak ...] [--size N] [--seed N]`.

`edits`: 8 pages edit one document at once, 10,000 edits. `undo`: edits of 48 kinds are made in random order
until each kind was undone and redone 1,000 times. `documents`: 2,090 mutated documents. `messages`: 3,614
hostile messages. `kills`: 50 kills while a page saves. `records`: 50 runs are killed while they record.
`bits`: 10,000 bits of files that deodar reads back are flipped, each alone.
`formats`: 100,000 mutated files of all formats are read, in hours; `--continue FILE` keeps a row of each, and
continues after those that it has; `--only N ...` reads some of them again, and `--format NAME` those of one.
`soak`: pages come and go for 600 seconds, and the studio must hold no more afterwards than before: memory,
files and sockets, Python objects, tasks, threads, sessions, connections, with the limits in
`tests/attacks/soak.py`. `--size` sets another number. The attacks are in `tests/attacks`; the tests run them
in a quick form. Ends with 1 if an attack found something.
"""

from __future__ import annotations

import argparse
import functools
import os
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))
from tests.attacks import bits, documents, edits, formats, kills, messages, records, soak, undo


def _edits(folder: Path, size: int, seed: int) -> tuple[str, list[str]]:
    found = edits.run(folder, 8, size, seed)
    return f"{found.accepted} accepted, {found.refused} refused, {found.versions} versions", [
        *found.errors,
        *found.differ,
    ]


def _undo(folder: Path, size: int, seed: int) -> tuple[str, list[str]]:
    found = undo.attack(size, seed)
    made, undone, redone = (sum(counts.values()) for counts in (found.made, found.undone, found.redone))
    least = min(undo.KINDS, key=found.least)
    return (
        f"{len(undo.KINDS)} kinds, {made} edits, {undone} undone, {redone} redone, each kind at least"
        f" {found.least(least)} times both ({least}), in {found.steps} steps"
    ), found.errors


def _documents(folder: Path, size: int, seed: int) -> tuple[str, list[str]]:
    found = documents.attack(size, seed)
    return f"{found.read} read, {found.refused} refused", found.errors


def _messages(folder: Path, size: int, seed: int) -> tuple[str, list[str]]:
    found = messages.run(folder, size, seed)
    return f"{found.sent} sent over {found.connections} connections, {found.refused} refused", found.errors


def _kills(folder: Path, size: int, seed: int) -> tuple[str, list[str]]:
    found = kills.attack(folder, size, seed)
    return (
        f"{found.kills} kills, {found.saves} saves, {found.abandoned} files left for the next save",
        found.errors,
    )


def _records(folder: Path, size: int, seed: int) -> tuple[str, list[str]]:
    found = records.attack(folder, size, seed)
    return (
        f"{found.kills} kills, {found.samples} samples kept, at most {found.worst:.2f} s lost,"
        f" {found.resumed} runs resumed"
    ), found.errors


def _bits(folder: Path, size: int, seed: int) -> tuple[str, list[str]]:
    outcome = bits.attack(folder, size, seed)
    return (
        f"{size} bits of {len(outcome.by_kind)} kinds of files; readers refused {outcome.refused} times, left"
        f" out what was damaged {outcome.shortened} times, returned what was written {outcome.equal} times"
    ), outcome.errors


def _formats(folder: Path, size: int, seed: int, part: formats.Part = formats.WHOLE) -> tuple[str, list[str]]:
    outcome = formats.attack(folder, size, seed, part)
    lines = "".join(f"\n  {name:16} {became}" for name, became in outcome.by_format.items())
    counts = f"{outcome.count('read')} read, {outcome.count('refused')} refused"
    return (
        f"{outcome.count()} mutations of {len(outcome.by_format)} formats, {counts}{lines}\n ",
        outcome.errors,
    )


def _soak(folder: Path, size: int, seed: int) -> tuple[str, list[str]]:
    found = soak.attack(folder, size, seed)
    return f"{found.visits} visits; after a quarter {found.early}, at the end {found.late}", found.errors


ATTACKS: dict[str, tuple[Callable[[Path, int, int], tuple[str, list[str]]], int]] = {
    "edits": (_edits, 10_000),
    "undo": (_undo, 1000),
    "documents": (_documents, 2090),
    "messages": (_messages, 3614),
    "kills": (_kills, 50),
    "records": (_records, 50),
    "bits": (_bits, 10_000),
    "formats": (_formats, 100_000),
    "soak": (_soak, 600),
}


def main() -> int:
    """Run the attacks that are named, or all."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument(
        "attack", nargs="*", choices=[*ATTACKS, []], metavar="ATTACK", help=", ".join(ATTACKS)
    )
    parser.add_argument(
        "--size",
        type=int,
        help="how many edits, undos and redos of each kind, documents, messages, kills, bits, files, seconds",
    )
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument(
        "--continue",
        dest="kept",
        metavar="FILE",
        type=Path,
        help="formats: rows of an attack that is continued",
    )
    parser.add_argument("--only", type=int, nargs="+", metavar="N", help="formats: numbers of mutations")
    parser.add_argument("--format", nargs="+", metavar="NAME", help="formats: those of some")
    args = parser.parse_args()
    part = formats.Part(args.kept, tuple(args.only or ()), tuple(args.format or ()))
    attacks = ATTACKS | {"formats": (functools.partial(_formats, part=part), ATTACKS["formats"][1])}
    errors = 0
    for name in args.attack or attacks:
        run, usual = attacks[name]
        with tempfile.TemporaryDirectory() as home:
            folder = Path(home) / "folder"
            folder.mkdir()
            os.environ["DEODAR_STATE"] = str(Path(home) / "state")
            began = time.perf_counter()
            said, found = run(folder, args.size or usual, args.seed)
        print(f"{name:10} {said}; {len(found)} errors; {time.perf_counter() - began:.0f} s", flush=True)
        for error in found[:20]:
            print(f"  {error[:1000]}", flush=True)
        errors += len(found)
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
