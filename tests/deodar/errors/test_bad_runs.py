"""Invalid runs: times, seeds, trials, sweeps, records, and runs that do not fit into memory."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.arithmetic import Product
from deodar.couplings.convolutions import Convolve, Shift
from deodar.couplings.projections import Resample
from deodar.couplings.weights import Weights
from deodar.elements.changing_stimuli import Noise
from deodar.elements.field import Field
from deodar.elements.stimuli import Boost
from deodar.errors import DeodarError, ModelError, NotFinite, ParameterError, TimeError, TooLarge, UnknownName
from deodar.numerics.kernels.separable import Box, MexicanHat
from tests.deodar.errors.refused import refused

X = dd.Axis("x", 0, 10, samples=11)
NAN, INF = float("nan"), float("inf")


@pytest.fixture(scope="module")
def model() -> dd.Model:
    """Return one field with one stimulus; its program is compiled once for all tests."""
    model = dd.Model("m")
    u = model.add(dd.Field("u", [X], tau=20, kernel=[dd.Gaussian(sigma=2)]))
    model.add(dd.GaussianStimulus("left", [X], center=5)) >> u
    return model


Call = Callable[[dd.Model], Any]

RUNS: dict[str, tuple[Call, type[DeodarError], tuple[str, ...]]] = {
    "no model": (lambda m: dd.simulate("m", 5), ModelError, ("expected a model, got 'm'", "dd.load(file)")),
    "no model, live": (lambda m: dd.Session(m.document), ModelError, ("expected a model",)),
    "dt 0": (lambda m: dd.simulate(m, 5, dt=0), TimeError, ("dt is 0; expected a number above 0, in ms",)),
    "dt negative": (lambda m: dd.simulate(m, 5, dt=-1), TimeError, ("dt is -1",)),
    "dt nan": (lambda m: dd.simulate(m, 5, dt=NAN), TimeError, ("dt is nan",)),
    "dt infinite": (lambda m: dd.simulate(m, 5, dt=INF), TimeError, ("dt is inf",)),
    "dt text": (lambda m: dd.simulate(m, 5, dt="1"), TimeError, ("dt is '1'",)),
    "dt a list": (lambda m: dd.simulate(m, 5, dt=[1]), TimeError, ("dt is [1]",)),
    "dt true": (lambda m: dd.simulate(m, 5, dt=True), TimeError, ("dt is True",)),
    "dt above tau": (
        lambda m: dd.simulate(m, 50, dt=25),
        TimeError,
        ("u: ", "longer than the time constant tau = 20", "Use dt <= 20"),
    ),
    "dt above tau in a sweep": (
        lambda m: dd.simulate(m, 5, sweep={"u.tau": [20, 0.5]}),
        TimeError,
        ("tau = 0.5",),
    ),
    "a duration between steps": (
        lambda m: dd.simulate(m, 5.5),
        TimeError,
        ("the duration of 5.5 is not a multiple of dt = 1", "Use 5 or 6"),
    ),
    "a duration below 0": (
        lambda m: dd.simulate(m, -5),
        TimeError,
        ("the duration is -5; expected a number, 0 or above",),
    ),
    "a duration of nan": (lambda m: dd.simulate(m, NAN), TimeError, ("the duration is nan",)),
    "an infinite duration": (lambda m: dd.simulate(m, INF), TimeError, ("the duration is inf",)),
    "a duration in words": (lambda m: dd.simulate(m, "500"), TimeError, ("the duration is '500'",)),
    "a duration of none": (lambda m: dd.simulate(m, None), TimeError, ("the duration is None",)),
    "a duration beyond counting": (
        lambda m: dd.simulate(m, 1e300),
        TimeError,
        ("the duration of 1e+300", "at most"),
    ),
    "every between steps": (
        lambda m: dd.simulate(m, 5, every=1.5),
        TimeError,
        ("every of 1.5 is not a multiple of dt = 1", "Use 1 or 2"),
    ),
    "every 0": (lambda m: dd.simulate(m, 5, every=0), TimeError, ("every is 0; expected at least one step",)),
    "every below 0": (lambda m: dd.simulate(m, 5, every=-1), TimeError, ("every is -1",)),
    "seed below 0": (lambda m: dd.simulate(m, 5, seed=-1), ParameterError, ("from 0 to 2^32 - 1, not -1",)),
    "seed too large": (
        lambda m: dd.simulate(m, 5, seed=2**32),
        ParameterError,
        ("from 0 to 2^32 - 1, not 4294967296",),
    ),
    "seed half": (lambda m: dd.simulate(m, 5, seed=0.5), ParameterError, ("not 0.5",)),
    "seed true": (lambda m: dd.simulate(m, 5, seed=True), ParameterError, ("not True",)),
    "seed none": (lambda m: dd.simulate(m, 5, seed=None), ParameterError, ("not None",)),
    "precision": (
        lambda m: dd.simulate(m, 5, precision="float16"),
        ParameterError,
        ("precision is 'float16'; expected float32, float32-exact, float64",),
    ),
    "precision, live": (
        lambda m: dd.Session(m, precision="double"),
        ParameterError,
        ("float32, float32-exact, float64",),
    ),
    "trials 0": (
        lambda m: dd.simulate(m, 5, trials=0),
        ParameterError,
        ("trials is 0; expected a number of trials, at least 1",),
    ),
    "trials below 0": (lambda m: dd.simulate(m, 5, trials=-3), ParameterError, ("trials is -3",)),
    "trials true": (lambda m: dd.simulate(m, 5, trials=True), ParameterError, ("trials is True",)),
    "trials half": (lambda m: dd.simulate(m, 5, trials=2.5), ParameterError, ("trials is 2.5",)),
    "trials in words": (lambda m: dd.simulate(m, 5, trials="ten"), ParameterError, ("trials is 'ten'",)),
    "trials of nothing": (
        lambda m: dd.simulate(m, 5, trials=[]),
        ParameterError,
        ("expected at least one trial",),
    ),
    "a trial twice": (lambda m: dd.simulate(m, 5, trials=[1, 1]), ParameterError, ("each named once",)),
    "a trial below 0": (lambda m: dd.simulate(m, 5, trials=[-1]), ParameterError, ("not -1",)),
    "trials beyond numbers": (
        lambda m: dd.simulate(m, 5, trials=10**30),
        ParameterError,
        ("trials is 1000",),
    ),
    "a sweep of nothing": (
        lambda m: dd.simulate(m, 5, sweep={"u.tau": []}),
        ParameterError,
        ("sweep of u.tau: needs a list of numbers",),
    ),
    "a sweep of one number": (
        lambda m: dd.simulate(m, 5, sweep={"u.tau": 5}),
        ParameterError,
        ("sweep of u.tau: needs a list of numbers, not 5",),
    ),
    "a sweep of words": (
        lambda m: dd.simulate(m, 5, sweep={"u.tau": ["a"]}),
        ParameterError,
        ("sweep of u.tau: needs a list of numbers",),
    ),
    "a sweep that is text": (
        lambda m: dd.simulate(m, 5, sweep={"u.tau": "12"}),
        ParameterError,
        ("needs a list of numbers, not '12'",),
    ),
    "a sweep of nan": (
        lambda m: dd.simulate(m, 5, sweep={"u.tau": [20, NAN]}),
        ParameterError,
        ("u.tau", "finite number, not nan"),
    ),
    "a sweep out of range": (
        lambda m: dd.simulate(m, 5, sweep={"u.tau": [20, -1]}),
        ParameterError,
        ("u.tau", "below its lower bound"),
    ),
    "a sweep that is a list": (
        lambda m: dd.simulate(m, 5, sweep=["u.tau"]),
        ParameterError,
        ("point 0 of the sweep", "gives a value for each parameter path, not 'u.tau'"),
    ),
    "a sweep that is a number": (
        lambda m: dd.simulate(m, 5, sweep=3),  # pyright: ignore[reportArgumentType]
        ParameterError,
        ("a sweep gives values for each parameter path, or a list of points, not 3",),
    ),
    "points with other paths": (
        lambda m: dd.simulate(m, 5, sweep=[{"u.tau": 20}, {"u.resting_level": -5}]),
        ParameterError,
        ("point 1 of the sweep", "has the paths u.resting_level; point 0 has u.tau"),
    ),
    "a point out of range": (
        lambda m: dd.simulate(m, 5, sweep=[{"u.tau": 20}, {"u.tau": -1}]),
        ParameterError,
        ("u.tau", "below its lower bound"),
    ),
    "a point with a word": (
        lambda m: dd.simulate(m, 5, sweep=[{"u.tau": "fast"}]),
        ParameterError,
        ("sweep of u.tau",),
    ),
    "noise of its own for a grid": (
        lambda m: dd.simulate(m, 5, sweep=dd.Points({"u.tau": [10, 20]}, own_noise=True)),
        ParameterError,
        ("dd.Points is a list of points, and this is a grid",),
    ),
    "noise of its own for too many trials": (
        lambda m: dd.simulate(m, 5, sweep=dd.Points([{"u.tau": 10}], own_noise=True), trials=[70_000]),
        ParameterError,
        ("own_noise serves 65536 points",),
    ),
    "a sweep of a sigmoid": (
        lambda m: dd.simulate(m, 5, sweep={"u.sigmoid": [1]}),
        ParameterError,
        ("u.sigmoid",),
    ),
    "a sweep of a flag": (
        lambda m: dd.simulate(m, 5, sweep={"u.kernel.0.normalized": [0, 1]}),
        ParameterError,
        ("makes another program", "Sweep one of: "),
    ),
    "a sweep of axes": (
        lambda m: dd.simulate(m, 5, sweep={"u.axes": [1]}),
        ParameterError,
        ("makes another program",),
    ),
    "a sweep of the name": (lambda m: dd.simulate(m, 5, sweep={"u.name": [1]}), ParameterError, ("u.name",)),
    "a sweep of a port": (
        lambda m: dd.simulate(m, 5, sweep={"u.output": [1]}),
        UnknownName,
        ("is a port, not a parameter",),
    ),
    "a sweep misspelt": (
        lambda m: dd.simulate(m, 5, sweep={"u.tua": [1]}),
        UnknownName,
        ("u has no parameter 'tua'", "Did you mean 'tau'?"),
    ),
    "a sweep of an unknown parameter": (
        lambda m: dd.simulate(m, 5, sweep={"lfet.amplitude": [1]}),
        UnknownName,
        ("Did you mean 'left.amplitude'?",),
    ),
    "a record misspelt": (
        lambda m: dd.simulate(m, 5, record=["u.activaton"]),
        UnknownName,
        ("u has no port 'activaton'", "Did you mean 'activation'?"),
    ),
    "a record of an unknown port": (
        lambda m: dd.simulate(m, 5, record=["w.output"]),
        UnknownName,
        ("nothing is called 'w.output'",),
    ),
    "a record of a parameter": (
        lambda m: dd.simulate(m, 5, record=["u.tau"]),
        UnknownName,
        ("is a parameter, not a port", "Ports of u: "),
    ),
    "a record of nothing": (lambda m: dd.simulate(m, 5, record=[]), ParameterError, ("record is empty",)),
    "a record of numbers": (
        lambda m: dd.simulate(m, 5, record=[5]),
        ParameterError,
        ("record names ports by their paths",),
    ),
    "a record that is a number": (
        lambda m: dd.simulate(m, 5, record=5),
        ParameterError,
        ("record names ports by their paths, not 5",),
    ),
    "no fields": (
        lambda m: dd.simulate(_boost_only(), 5),
        ParameterError,
        ("has no field", "record=['left.output']"),
    ),
    "steps half": (lambda m: dd.Session(m).step(0.5), TimeError, ("not 0.5",)),
    "steps below 0": (lambda m: dd.Session(m).step(-1), TimeError, ("not -1",)),
    "a live duration between steps": (lambda m: dd.Session(m).run(1.5), TimeError, ("not a multiple of dt",)),
    "a live dt": (lambda m: setattr(dd.Session(m), "dt", 0), TimeError, ("dt is 0",)),
    "a live dt above tau": (
        lambda m: setattr(dd.Session(m), "dt", 21),
        TimeError,
        ("longer than the time constant",),
    ),
    "a live set misspelt": (
        lambda m: dd.Session(m).set("left.amplitud", 1),
        UnknownName,
        ("Did you mean 'amplitude'?",),
    ),
    "a live set of nan": (
        lambda m: dd.Session(m).set("left.amplitude", NAN),
        ParameterError,
        ("left.amplitude", "finite"),
    ),
    "a live set of text": (
        lambda m: dd.Session(m).set("left.amplitude", "8"),
        ParameterError,
        ("needs a number, not '8'",),
    ),
    "a live tau below dt": (
        lambda m: dd.Session(m).set("u.tau", 0.5),
        TimeError,
        ("longer than the time constant tau = 0.5",),
    ),
    "a live read misspelt": (
        lambda m: dd.Session(m).read("u.outptu"),
        UnknownName,
        ("Did you mean 'output'?",),
    ),
    "a live get misspelt": (lambda m: dd.Session(m).get("u.tua"), UnknownName, ("Did you mean 'tau'?",)),
}


def _boost_only() -> dd.Model:
    model = dd.Model("m")
    model.add(Boost("left"))
    return model


@pytest.mark.parametrize("name", RUNS)
def test_invalid_runs_are_refused(model: dd.Model, name: str) -> None:
    call, error, says = RUNS[name]
    before = model.document
    refused(lambda: call(model), error, *says)
    assert model.document is before


def test_a_refused_set_does_not_change_the_session(model: dd.Model) -> None:
    s = dd.Session(model)
    s.step(3)
    before, journal = s.read("u.activation"), list(s.journal)
    for path, number in (
        ("u.tau", 0.5),
        ("u.tau", NAN),
        ("u.tua", 1),
        ("u.sigmoid", 5),
        ("u.kernel.7.sigma", 1),
    ):
        with pytest.raises(DeodarError):
            s.set(path, number)
    assert s.get("u.tau") == 20 and s.journal == journal and s.tick == 3
    assert np.array_equal(s.read("u.activation"), before)


def _fields(*samples: int, **options: Any) -> dd.Model:
    model = dd.Model("large")
    model.add(
        Field(
            "u",
            [dd.Axis(name, 0, 10, samples=n) for name, n in zip("abcd", samples, strict=False)],
            **options,
        )
    )
    return model


def _large_weights() -> dd.Model:
    model = dd.Model("large")
    axes = [dd.Axis("a", 0, 10, samples=1_000_000)]
    model.add(Field("u", axes, kernel=[dd.Gaussian()]))
    return model


LARGE: dict[str, Callable[[], Any]] = {
    "four axes of 1000": lambda: dd.simulate(_fields(1000, 1000, 1000, 1000), 5),
    "four axes of 1000, live": lambda: dd.Session(_fields(1000, 1000, 1000, 1000)),
    "four axes of a million": lambda: dd.simulate(_fields(10**6, 10**6, 10**6, 10**6), 5),
    "a kernel over a million samples": lambda: dd.simulate(_large_weights(), 5, precision="float64"),
    "10**9 trials": lambda: dd.simulate(_fields(11), 5, trials=10**9),
    "a record of every step": lambda: dd.simulate(_fields(1000, 1000), 10**6, record="u.activation"),
    "a sweep of 10**12 points": lambda: dd.simulate(
        _fields(11),
        5,
        sweep={
            "u.tau": np.linspace(10, 20, 10**4),
            "u.resting_level": np.linspace(-5, 0, 10**4),
            "u.global_inhibition": range(10**4),
        },
    ),
    "noise with a correlation over a million samples": lambda: dd.simulate(
        _fields(10**6, noise=1.0, noise_length=5.0), 5
    ),
}

LARGE |= {
    "a shift of a million samples": lambda: _through(Shift(5.0)),
    "a convolution of a million samples": lambda: _through(Convolve([dd.Gaussian()]), precision="float64"),
    "resampling a million samples": lambda: _through(Resample([dd.Axis("a", 0, 10, samples=900_000)])),
    "a projection of a million samples": lambda: _through(dd.Project([dd.Axis("a", 0, 10, samples=900_000)])),
}


def _through(coupling: Any, **settings: Any) -> Any:
    model = _fields(10**6)
    model["u"] >> coupling
    return dd.simulate(model, 5, **settings)


@pytest.mark.parametrize("name", LARGE)
def test_a_record_that_exceeds_memory_is_refused_before_allocation(name: str) -> None:
    import resource

    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    refused(
        LARGE[name],
        TooLarge,
        "this run needs about",
        "GiB",
        "most of it is u",
        "Use fewer samples, fewer trials, or a larger `every`",
    )
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 400_000, (
        "nothing large was allocated (kilobytes)"
    )


def _finite(model: dd.Model, **options: Any) -> None:
    record = dd.simulate(
        model, duration=20, record=["u.activation", "u.output", "u.interaction"], every=5, **options
    )
    for name in record:
        assert np.isfinite(record[name].values).all(), name


NARROW = [1e-6, 1e-4, 1e-2]


@pytest.mark.parametrize("kernel", [dd.Gaussian, Box, MexicanHat], ids=lambda k: k.__name__)
@pytest.mark.parametrize("periodic", [False, True])
def test_widths_near_zero_give_finite_values(kernel: Any, periodic: bool) -> None:
    axis = dd.Axis("x", 0, 10, samples=11, periodic=periodic)
    width = {Box: "width", MexicanHat: "sigma_excitation"}.get(kernel, "sigma")
    model = dd.Model("m")
    u = model.add(
        dd.Field(
            "u", [axis], kernel=[kernel(**{width: NARROW[0]}), kernel(**{width: NARROW[0]}, normalized=True)]
        )
    )
    model.add(dd.GaussianStimulus("s", [axis], center=5, sigma=1e-6, amplitude=8)) >> u
    _finite(model, sweep={"u.kernel.0." + width: NARROW, "u.kernel.1." + width: NARROW})


def test_widths_far_beyond_the_axis_give_finite_values() -> None:
    axis = dd.Axis("x", 0, 10, samples=11, periodic=True)
    model = dd.Model("m")
    model.add(dd.Field("u", [axis], kernel=[dd.Gaussian(sigma=1e9), dd.Gaussian(sigma=1e9, normalized=True)]))
    _finite(model)


def test_a_field_over_one_sample_runs() -> None:
    axis = dd.Axis("x", 0, 10, samples=1, periodic=True)
    model = dd.Model("m")
    u = model.add(dd.Field("u", [axis], kernel=[dd.Gaussian(sigma=2), Box(width=3)], noise=0.1))
    model.add(dd.GaussianStimulus("s", [axis])) >> u
    _finite(model)


def test_a_field_over_two_samples_runs() -> None:
    model = dd.Model("m")
    axis = dd.Axis("x", 0, 10, samples=2)
    model.add(dd.Field("u", [axis], kernel=[dd.Gaussian(sigma=2)], noise=0.1, noise_length=1.0))
    _finite(model)


def test_a_step_equal_to_the_time_constant_is_accepted() -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", [X], tau=5, kernel=[dd.Gaussian(sigma=2)]))
    _finite(model, dt=5)


def test_the_step_of_a_slow_part_is_compared_with_its_time_constant() -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", [X], tau=5), ticks=4)
    refused(
        lambda: dd.simulate(model, 8, dt=2),
        TimeError,
        "u: the step of 8 ms is longer than the time constant tau = 5",
        "Use dt <= 1.25",
    )


def test_a_run_of_no_steps_records_the_initial_state() -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", [X], resting_level=-3))
    record = dd.simulate(model, 0, record="u.activation")
    assert record["time"].values.tolist() == [0.0]
    assert (record["u.activation"].values == -3).all()


def test_a_diverging_run_names_the_element_and_the_step() -> None:
    model = dd.Model("m")
    u = model.add(dd.Field("runaway", [X], tau=1, resting_level=1, sigmoid=_linear()))
    u >> dd.Gain(1e30) >> u
    text = refused(
        lambda: dd.simulate(model, 100, dt=1, record="runaway.activation"),
        NotFinite,
        "runaway",
        "in step",
        "dt 1",
        "smaller dt",
    )
    assert "u>Gain" not in text


def _linear() -> Any:
    from deodar.numerics.sigmoids import Linear

    return Linear()


def test_a_model_with_problems_is_refused_with_all_of_them() -> None:
    model = dd.Model("m")
    u = model.add(dd.Field("u", [X]))
    u >> Weights(np.eye(3), [X], name="w") >> u
    model.add(Product(name="p"))
    refused(
        lambda: dd.simulate(model, 5),
        ModelError,
        "2 problems",
        "w (test_bad_runs.py:",
        "p (test_bad_runs.py:",
    )


def test_noise_correlated_along_one_axis_only_is_refused() -> None:
    model = dd.Model("m")
    model.add(Noise("n", [X, dd.Axis("y", 0, 1, 3)], length=[1, 0]))
    refused(
        lambda: dd.simulate(model, 5, record="n.output"),
        ModelError,
        "length is 0 on one axis and not on another",
    )
