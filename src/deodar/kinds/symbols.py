"""Names as mathematical symbols: sigma_excitation is a Greek letter with a word below it."""

from __future__ import annotations

import re

_LETTERS = (
    "alpha beta gamma delta epsilon zeta eta theta kappa lambda mu nu xi pi rho sigma tau phi chi psi omega"
    " Gamma Delta Theta Lambda Xi Pi Sigma Phi Psi Omega"
)
GREEK = frozenset(_LETTERS.split())

NAME = re.compile(r"[A-Za-z][A-Za-z0-9]*(?:_[A-Za-z0-9]+)*'*")
"""A name as equations write it, with subscripts and primes."""


def is_letter(name: str) -> bool:
    """Whether a name is a letter of some alphabet, perhaps with a number, subscripts and primes: u, x', t_n,
    u1, sigma_i.
    """
    base = name.rstrip("'").split("_")[0]
    return base in GREEK or re.fullmatch(r"[A-Za-z]\d*", base) is not None


def symbol(name: str) -> str:
    """A name in TeX."""
    plain = name.rstrip("'")
    base, *below = plain.split("_")
    numbered = re.fullmatch(r"([A-Za-z])(\d+)", base)
    if numbered:
        base, below = numbered[1], [numbered[2], *below]
    low = r"\,".join(_letters(b) for b in below)
    primes = "'" * (len(name) - len(plain))
    if low:
        low = f"_{low}" if len(low) == 1 else f"_{{{low}}}"
    return _letters(base) + low + primes


def _letters(word: str) -> str:
    if word in GREEK:
        return f"\\{word}"
    return word if len(word) == 1 or word.isdigit() else rf"\mathrm{{{word}}}"
