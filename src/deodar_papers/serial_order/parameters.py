"""Table B.1: each parameter with the printed value, ours, and what it sets; and those varied alone."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from deodar.architectures.color_search import (
    ATTRACTION,
    CAUTION,
    CRUISE,
    EXCITATION,
    HUES,
    INERTIA,
    INHIBITION,
    LARGE,
    REPULSION,
    RESTING,
    RIDGE,
    SEEN,
    SHOWN,
    TAUGHT,
    TURNING,
    WHOLE,
    WIDTH,
)
from deodar.architectures.serial_order import BOOST, LEARN, OFF, PREDICT, READ, STEEP, STRENGTHS, TAU
from deodar.architectures.serial_order import EXCITATION as CHAIN_EXCITATION
from deodar.architectures.serial_order import INHIBITION as CHAIN_INHIBITION
from deodar.architectures.serial_order import RESTING as CHAIN_RESTING
from deodar.architectures.serial_order import WIDTH as CHAIN_WIDTH
from deodar.errors import UnknownName, did_you_mean

ParameterValues = Mapping[str, float]
"""Values of parameters by path; a path that begins with `*.` is that of every item of the chain."""

FIELDS = ("*.node", "*.memory", "action", "satisfaction", "colour space")


@dataclass(frozen=True)
class TableParameter:
    """A parameter of table B.1.

    Attributes:
        name: its name; names of conditions contain it.
        printed, ours: the value of the table, and ours, both with the sign and the unit of the table.
        values: the values of the model's parameters when ours is multiplied by a factor; None if the body or
            the grid fixes it.
        words: the name in tables of the manual; empty: `name`.
        reason: why ours differs from the printed value.
    """

    name: str
    printed: float
    ours: float
    values: Callable[[float], ParameterValues] | None
    words: str = ""
    reason: str = ""

    @property
    def label(self) -> str:
        """The name in tables of the manual."""
        return self.words or self.name


def _scaled(*paths: str, of: float) -> Callable[[float], ParameterValues]:
    return lambda factor: dict.fromkeys(paths, of * factor)


def _turns(attraction: float, repulsion: float) -> ParameterValues:
    half = 1000.0 / 2
    return {
        "turn by attraction.factor": attraction * half / TURNING,
        "turn by repulsion.factor": repulsion * half / TURNING,
    }


def _of_pairs(number: int, printed: float) -> TableParameter:
    """Return c_0 to c_6, which the table prints without their sign."""
    [(strength, ours)] = [(name, c) for name, c in STRENGTHS.items() if name.startswith(f"c{number} ")]
    return TableParameter(f"c_{number}", printed, abs(ours), _scaled(strength, of=ours))


REASONS = {
    "h_d": "the next node gets at most h_d + c_2, -4.1 as printed, and none would become active",
    "c_inh": "0.9 less 5 is below 0: no peak could sustain itself",
    "c_CoS": "a single noisy sample above threshold would switch a node off, before a peak exists",
    "boost": "h_A + 10 is above 0 at every hue: the whole action field would be above threshold",
    "c_A": "the condition would be satisfied when a block fills half of the middle of the picture; with 1.2"
    " it has to fill 0.8 of it",
    "h_p": "the ridge alone, h_p + c_A^P, would be above threshold: 0.5 as printed",
    "c_exc^P": "a blob of 75 x 12 samples would be far above threshold, and then shut the field",
    "c_inh^P": "a blob of 75 x 12 samples inhibits the whole field by 450 as printed, and by 4.5 here",
    "v_tar": "five times as fast, which shortens all searches",
    "v_obs": "as for v_tar",
}
"""Why ours differs from the printed value."""

_BOTH = "of action and satisfaction"

TABLE = (
    TableParameter("tau", 10.0, TAU, _scaled(*(f"{f}.tau" for f in FIELDS), of=TAU), "tau, ms"),
    TableParameter("tau_l", 20.0, 1 / LEARN, lambda factor: {"*.meaning.rate": LEARN / factor}, "tau_l, ms"),
    TableParameter("beta", 100.0, STEEP, _scaled(*(f"{f}.sigmoid.beta" for f in FIELDS), of=STEEP)),
    *(
        TableParameter(
            letter, printed, ours, _scaled(f"{path}.resting_level", of=ours), reason=REASONS.get(letter, "")
        )
        for letter, printed, path, ours in (
            ("h_d", -5.0, "*.node", CHAIN_RESTING["node"]),
            ("h_m", -2.0, "*.memory", CHAIN_RESTING["memory"]),
            ("h_A", -1.8, "action", CHAIN_RESTING["action"]),
            ("h_C", -2.0, "satisfaction", CHAIN_RESTING["satisfaction"]),
        )
    ),
    *(_of_pairs(number, printed) for number, printed in enumerate((7.2, 3.6, 0.9, 0.8, 3.5, 2.0, 2.6))),
    *(
        TableParameter(
            letter,
            printed,
            ours,
            _scaled(f"action.{path}", f"satisfaction.{path}", of=ours),
            f"{letter} {_BOTH}",
            REASONS.get(letter, ""),
        )
        for letter, printed, path, ours in (
            ("c_exc", 0.9, "kernel.0.amplitude", CHAIN_EXCITATION),
            ("sigma", 3.0, "kernel.0.sigma", CHAIN_WIDTH),
            ("c_inh", 5.0, "global_inhibition", CHAIN_INHIBITION),
        )
    ),
    TableParameter("c_CoS", 15.0, -OFF, _scaled("off.factor", of=OFF), reason=REASONS["c_CoS"]),
    TableParameter("c_ord", 10.0, READ, _scaled("c_ord.factor", of=READ)),
    TableParameter(
        "boost", 10.0, BOOST, _scaled("boost.factor", of=BOOST), "c_ord as boost", REASONS["boost"]
    ),
    TableParameter("c_A", 1.5, PREDICT, _scaled("predict.factor", of=PREDICT), reason=REASONS["c_A"]),
    TableParameter("c_vis", 2.0, SHOWN, _scaled("strength shown.factor", of=SHOWN)),
    TableParameter(
        "c_vis,C",
        1.0,
        LARGE,
        _scaled("strength of large.factor", of=LARGE * WHOLE),
        "c_vis of satisfaction",
    ),
    TableParameter(
        "h_p",
        -2.0,
        RESTING,
        lambda factor: {
            "colour space.resting_level": RESTING * factor,
            "taught.factor": TAUGHT + RESTING * (1 - factor),
        },
        reason=REASONS["h_p"],
    ),
    TableParameter(
        "h_p (learning)",
        -1.0,
        RESTING + TAUGHT,
        lambda factor: {"taught.factor": TAUGHT * factor + RESTING * (factor - 1)},
        "h_p while learning",
    ),
    TableParameter("c_A^P", 2.5, RIDGE, _scaled("wanted.factor", of=RIDGE)),
    TableParameter("c_vis^P", 2.0, SEEN, _scaled("seen.factor", of=SEEN * WHOLE)),
    TableParameter(
        "c_exc^P",
        0.6,
        EXCITATION,
        _scaled("colour space.kernel.0.amplitude", of=EXCITATION),
        reason=REASONS["c_exc^P"],
    ),
    TableParameter(
        "c_inh^P",
        0.5,
        INHIBITION,
        _scaled("colour space.global_inhibition", of=INHIBITION),
        reason=REASONS["c_inh^P"],
    ),
    TableParameter("sigma^P", 3.0, WIDTH, _scaled("colour space.kernel.0.sigma", of=WIDTH)),
    TableParameter(
        "tau_nav",
        80.0,
        TURNING,
        lambda factor: _turns(ATTRACTION / factor, REPULSION / factor),
        "tau_nav, ms",
    ),
    TableParameter("tau_vel", 30.0, INERTIA, _scaled("speed.tau", of=INERTIA), "tau_vel, ms"),
    TableParameter("lambda_tar", 0.2, ATTRACTION, lambda factor: _turns(ATTRACTION * factor, REPULSION)),
    TableParameter("lambda_obs", 1.0, REPULSION, lambda factor: _turns(ATTRACTION, REPULSION * factor)),
    TableParameter("beta_1", 15.0, 15.0, _scaled("repulsion.strength", of=15.0)),
    TableParameter("beta_2", 30.0, 30.0, _scaled("repulsion.reach", of=30.0)),
    TableParameter("R", 100.0, 100.0, _scaled("repulsion.size", of=100.0), "R, mm"),
    TableParameter("delta_psi", 45.0, 45.0, _scaled("repulsion.view", of=45.0), "delta_psi, degrees"),
    TableParameter(
        "v_tar",
        60.0,
        CRUISE,
        lambda factor: {
            "speed.resting_level": CRUISE * factor,
            "caution.factor": CAUTION - CRUISE * factor,
        },
        "v_tar, pulses/s",
        REASONS["v_tar"],
    ),
    TableParameter(
        "v_obs",
        30.0,
        CAUTION,
        lambda factor: {"caution.factor": CAUTION * factor - CRUISE},
        "v_obs, pulses/s",
        REASONS["v_obs"],
    ),
    TableParameter("N", 180.0, float(HUES), None),
)
"""The parameters of table B.1 that are single numbers and occur in an equation.

`c_ord` and `h_p` are two each: the paper uses c_ord for the homogeneous boost, too, and prints two values of
h_p. Left out are the directions of the infrared sensors Psi_i and the size of the picture N_sp, which are
lists, and c_p, which occurs in no equation.
"""


PARAMETERS: Mapping[str, Callable[[float], ParameterValues]] = {
    parameter.name: parameter.values for parameter in TABLE if parameter.values is not None
}
"""For each parameter the values of the model's parameters, when it is multiplied by a factor."""


def values(parameter: str, factor: float, items: int) -> dict[str, float]:
    """Return the values of parameters of a chain of `items` items, one parameter of the table multiplied."""
    if parameter not in PARAMETERS:
        raise UnknownName(f"there is no parameter {parameter!r}", fix=did_you_mean(parameter, PARAMETERS))
    out: dict[str, float] = {}
    for path, value in PARAMETERS[parameter](factor).items():
        every = path.startswith("*.")
        names = [f"item {k}{path[1:]}" for k in range(1, items + 1)] if every else [path]
        out |= dict.fromkeys(names, value)
    return out
