"""Parameters of table B.1, each varied alone."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from deodar.architectures.color_search import (
    ATTRACTION,
    CAUTION,
    CRUISE,
    EXCITATION,
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
"""ParameterValues of parameters by path; a path that begins with `*.` is that of every item of the chain."""

FIELDS = ("*.node", "*.memory", "action", "satisfaction", "colour space")


def _scaled(*paths: str, of: float) -> Callable[[float], ParameterValues]:
    return lambda factor: dict.fromkeys(paths, of * factor)


def _turns(attraction: float, repulsion: float) -> ParameterValues:
    half = 1000.0 / 2
    return {
        "turn by attraction.factor": attraction * half / TURNING,
        "turn by repulsion.factor": repulsion * half / TURNING,
    }


_LONG = {name.split(" ")[0]: name for name in STRENGTHS}

PARAMETERS: Mapping[str, Callable[[float], ParameterValues]] = {
    "tau": _scaled(*(f"{f}.tau" for f in FIELDS), of=TAU),
    "tau_l": lambda factor: {"*.meaning.rate": LEARN / factor},
    "beta": _scaled(*(f"{f}.sigmoid.beta" for f in FIELDS), of=STEEP),
    "h_d": _scaled("*.node.resting_level", of=CHAIN_RESTING["node"]),
    "h_m": _scaled("*.memory.resting_level", of=CHAIN_RESTING["memory"]),
    "h_A": _scaled("action.resting_level", of=CHAIN_RESTING["action"]),
    "h_C": _scaled("satisfaction.resting_level", of=CHAIN_RESTING["satisfaction"]),
    **{f"c_{n}": _scaled(_LONG[f"c{n}"], of=STRENGTHS[_LONG[f"c{n}"]]) for n in range(7)},
    "c_exc": _scaled("action.kernel.0.amplitude", "satisfaction.kernel.0.amplitude", of=CHAIN_EXCITATION),
    "sigma": _scaled("action.kernel.0.sigma", "satisfaction.kernel.0.sigma", of=CHAIN_WIDTH),
    "c_inh": _scaled("action.global_inhibition", "satisfaction.global_inhibition", of=CHAIN_INHIBITION),
    "c_ord": _scaled("c_ord.factor", of=READ),
    "boost": _scaled("boost.factor", of=BOOST),
    "c_CoS": _scaled("off.factor", of=OFF),
    "c_A": _scaled("predict.factor", of=PREDICT),
    "c_vis": _scaled("strength shown.factor", of=SHOWN),
    "c_vis,C": _scaled("strength of large.factor", of=LARGE * WHOLE),
    "h_p": lambda factor: {
        "colour space.resting_level": RESTING * factor,
        "taught.factor": TAUGHT + RESTING * (1 - factor),
    },
    "h_p (learning)": lambda factor: {"taught.factor": TAUGHT * factor + RESTING * (factor - 1)},
    "c_A^P": _scaled("wanted.factor", of=RIDGE),
    "c_vis^P": _scaled("seen.factor", of=SEEN * WHOLE),
    "c_exc^P": _scaled("colour space.kernel.0.amplitude", of=EXCITATION),
    "c_inh^P": _scaled("colour space.global_inhibition", of=INHIBITION),
    "sigma^P": _scaled("colour space.kernel.0.sigma", of=WIDTH),
    "tau_nav": lambda factor: _turns(ATTRACTION / factor, REPULSION / factor),
    "tau_vel": _scaled("speed.tau", of=INERTIA),
    "lambda_tar": lambda factor: _turns(ATTRACTION * factor, REPULSION),
    "lambda_obs": lambda factor: _turns(ATTRACTION, REPULSION * factor),
    "beta_1": _scaled("repulsion.strength", of=15.0),
    "beta_2": _scaled("repulsion.reach", of=30.0),
    "R": _scaled("repulsion.size", of=100.0),
    "delta_psi": _scaled("repulsion.view", of=45.0),
    "v_tar": lambda factor: {
        "speed.resting_level": CRUISE * factor,
        "caution.factor": CAUTION - CRUISE * factor,
    },
    "v_obs": lambda factor: {"caution.factor": CAUTION * factor - CRUISE},
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
