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
    """Return the problems of a line of TeX: unpaired braces and brackets, unknown commands."""
    bare = re.sub(r"\\[\\{}_,!; ]", "", line)
    found: list[str] = []
    depth = 0
    for sign in re.findall(r"[{}]", bare):
        depth += 1 if sign == "{" else -1
        if depth < 0:
            break
    if depth:
        found.append("braces")
    found += [
        a
        for a, b in ((r"\left", r"\right"), (r"\begin", r"\end"))
        if len(re.findall(rf"\{a}(?![a-z])", bare)) != len(re.findall(rf"\{b}(?![a-z])", bare))
    ]
    return found + sorted(set(re.findall(r"\\([A-Za-z]+)", bare)) - COMMANDS)


@pytest.mark.parametrize("name", KINDS)
def test_every_equation_is_valid_tex(name: str) -> None:
    lines = describe(KINDS[name], KINDS).equation
    assert lines and not [fault for line in lines for fault in faults(line)], lines
    assert not [
        line
        for line in lines
        if "$" in line or ("=" not in line and r"\quad {}" not in line and not line.endswith(r"\text{:}"))
    ], lines


@pytest.mark.parametrize(
    ("line", "found"),
    [(r"\frac{a}{b", ["braces"]), (r"\left( a", [r"\left"]), (r"\fraq{a}{b}", ["fraq"]), (r"}{", ["braces"])],
)
def test_invalid_tex_is_found(line: str, found: list[str]) -> None:
    assert faults(line) == found
