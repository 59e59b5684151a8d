"""Equations of docstrings in TeX: every one of them, the rules one by one, and what is no equation."""

from __future__ import annotations

import re

import pytest

from deodar import registry
from deodar.server.docstring import docstring
from deodar.server.equation import quantities, tex

KINDS = {name: cls for name, cls in registry.kinds().items() if cls.__module__.startswith("deodar.")}

WRITTEN = (
    "frac tfrac int sum prod exp log ln sin cos tan tanh max min sqrt le ge ne cdot left right mathrm text textstyle quad begin end"
    " textbackslash textasciicircum textasciitilde alpha beta gamma delta epsilon zeta eta theta kappa lambda mu nu xi pi rho sigma tau phi chi"
    " psi omega Gamma Delta Theta Lambda Xi Pi Sigma Phi Psi Omega"
)
COMMANDS = set(WRITTEN.split())
"""What is written by the rules; KaTeX knows all of it."""


def is_sound(line: str) -> bool:
    """Whether braces, brackets that grow and cases are paired, and every command is known."""
    bare = re.sub(r"\\[\\{}$&#%_,!; ]", "", line)
    depth = 0
    for sign in re.findall(r"[{}]", bare):
        depth += 1 if sign == "{" else -1
        if depth < 0:
            return False
    paired = bare.count(r"\left") == bare.count(r"\right") and bare.count(r"\begin") == bare.count(r"\end")
    return depth == 0 and paired and set(re.findall(r"\\([A-Za-z]+)", bare)) <= COMMANDS and "\\" not in re.sub(r"\\[A-Za-z]+", "", bare)


@pytest.mark.parametrize("name", KINDS)
def test_every_equation_is_sound_tex(name: str) -> None:
    lines = tex(docstring(KINDS[name]).equation)
    assert lines and all(is_sound(line) for line in lines), lines


@pytest.mark.parametrize(
    ("written", "made"),
    [
        ("tau du/dt = -u + h", r"\tau\, \frac{du}{dt} = -u + h"),
        ("dphi/dt = -phi", r"\frac{d\phi}{dt} = -\phi"),
        ("y(x) = integral k(x - x') f(x') dx'", r"y(x) = \int k(x - x')\, f(x')\, dx'"),
        ("y = sum_k a_k", r"y = \sum_{k} a_k"),
        ("y = sum_i^n a_i", r"y = \sum_{i}^{n} a_i"),
        (
            "k = amplitude * prod_i exp(-d_i^2 / (2 sigma_i^2))",
            r"k = \mathrm{amplitude} \, \prod_{i} \exp\!\left( -\frac{d_i^{2}}{2 \sigma_i^{2}} \right)",
        ),
        ("g(u) = 1 / (1 + exp(-beta (u - theta)))", r"g(u) = \frac{1}{1 + e^{-\beta\, (u - \theta)}}"),
        ("y = q sqrt(dt) / tau xi_n", r"y = \frac{q\, \sqrt{dt}}{\tau}\, \xi_n"),
        ("y = 1/2 (1 + u)", r"y = \tfrac{1}{2}\, (1 + u)"),
        ("y = |u - theta| / 2", r"y = |u - \theta| / 2"),
        ("s = sigma_excitation + x_cmd", r"s = \sigma_{\mathrm{excitation}} + x_{\mathrm{cmd}}"),
        ("y = rate * u", r"y = \mathrm{rate} \cdot u"),
        ("tau dz/dt = -z + input", r"\tau\, \frac{dz}{dt} = -z + \mathrm{input}"),
        ("y = max(0, slope (u - theta))", r"y = \max(0,\, \mathrm{slope}\, (u - \theta))"),
        ("y = weights[centre + d / spacing]", r"y = \mathrm{weights}[\mathrm{centre} + d / \mathrm{spacing}]"),
        ("y = 2 pi x^2", r"y = 2 \pi\, x^{2}"),
        ("a <= b", r"a \le b"),
        ("g(u) = 1 where u > theta, else 0", r"g(u) = \begin{cases} 1 & \text{where }u > \theta \\ 0 & \text{else} \end{cases}"),
    ],
)
def test_a_formula_is_typeset(written: str, made: str) -> None:
    assert tex(written) == [made]
    assert is_sound(made)


def test_words_stay_words_and_letters_among_them_are_symbols() -> None:
    assert tex("f is the input.") == [r"f\text{ is the input.}"]
    assert tex("f is the input.", ["input"]) == [r"f\text{ is the }\mathrm{input}\text{.}"]
    assert tex("Its integral decides how fast phi moves") == [r"\text{Its integral decides how fast }\phi\text{ moves}"]
    assert tex("a step of the world's clock") == [r"\text{a step of the world's clock}"]


def test_clauses_stand_on_lines_of_their_own() -> None:
    assert tex("N = integral f(x) dx; y = 1/N; the rest is zero.") == [r"N = \int f(x)\, dx", r"y = \frac{1}{N}", r"\text{the rest is zero.}"]
    assert tex("ring: y = x.") == [r"\text{ring:}", "y = x"]


def test_long_lines_are_broken_at_signs_and_between_words() -> None:
    field = tex("tau du/dt = -u + h + s(x, t) + sum_k integral k(x - x') g(u(x')) dx' - c integral g(u) dx + q xi(x, t)")
    assert len(field) > 1 and all(is_sound(line) for line in field)
    assert all(re.match(r"\\quad \{\} [+-] ", line) for line in field[1:])
    words = tex("zero beyond the ends of an axis that is not periodic, and whatever else there may be to say about this one")
    assert len(words) > 1 and all(len(line) <= 60 for line in words)


WRONG = "( f(x x) *u a//b x^ |u || exp() f(,) {} ` integral = ^ _ \\input{x} $&#%~ ¼ü漢"


@pytest.mark.parametrize("written", ["", " ", "1 +", "((((" * 500, "(" * 500 + "x" + ")" * 500, *WRONG.split()])
def test_what_is_no_formula_is_shown_as_it_is(written: str) -> None:
    assert all(is_sound(line) for line in tex(written))


def test_names_that_occur() -> None:
    used = quantities("s(x) = amplitude * exp(-(x - center_i)^2); on a periodic axis the shortest way")
    assert {"amplitude", "center", "x"} <= used
    assert not {"axis", "periodic", "way"} & used
