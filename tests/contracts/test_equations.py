"""Equations of docstrings: lines of TeX that the page and the manual can typeset."""

from __future__ import annotations

import re

import pytest

from deodar import registry
from deodar.kinds.description import describe

KINDS = {name: cls for name, cls in registry.kinds().items() if registry.own(cls)}

# fmt: off
COMMANDS = {
    "frac", "int", "sum", "prod", "exp", "ln", "max", "min", "sqrt", "arg", "sin", "bmod", "cdot", "left",
    "right", "leftarrow", "mathrm", "text", "operatorname", "quad", "begin", "end", "forall", "in", "langle",
    "rangle", "le", "ge", "alpha", "beta", "epsilon", "theta", "lambda", "phi", "pi", "psi", "sigma", "tau",
    "xi", "Delta", "tan", "arctan",
}
# fmt: on
"""All commands in use; KaTeX and MathML support each. View a new one before you add it here."""


def faults(line: str) -> list[str]:
    """Return the problems of a line of TeX: unpaired signs, no equals sign, unknown commands."""
    bare = re.sub(r"\\[\\{}_,!; ]", "", line)
    complaints: list[str] = []
    depth = 0
    for sign in re.findall(r"[{}]", bare):
        depth += 1 if sign == "{" else -1
        if depth < 0:
            break
    if depth:
        complaints.append("braces")
    complaints += [
        a
        for a, b in ((r"\left", r"\right"), (r"\begin", r"\end"))
        if len(re.findall(rf"\{a}(?![a-z])", bare)) != len(re.findall(rf"\{b}(?![a-z])", bare))
    ]
    if "=" not in line and r"\quad {}" not in line and not line.endswith(r"\text{:}"):
        complaints.append("=")
    if "$" in line:
        complaints.append("$")
    return complaints + sorted(set(re.findall(r"\\([A-Za-z]+)", bare)) - COMMANDS)


def test_every_equation_is_valid_tex() -> None:
    wrong: list[str] = []
    for name, cls in KINDS.items():
        lines = describe(cls, KINDS).equation
        assert lines, name
        wrong += [f"{name}: {fault} in {line}" for line in lines for fault in faults(line)]
    assert not wrong, wrong


@pytest.mark.parametrize(
    ("line", "complaints"),
    [
        (r"y = \frac{a}{b", ["braces"]),
        (r"y = \left( a", [r"\left"]),
        (r"y = \fraq{a}{b}", ["fraq"]),
        (r"y = }{", ["braces"]),
        (r"y", ["="]),
        (r"$y = a$", ["$"]),
    ],
)
def test_invalid_tex_is_found(line: str, complaints: list[str]) -> None:
    assert faults(line) == complaints
