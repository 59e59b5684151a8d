"""No result depends on the order of declaration, names, grouping, batches or chunks."""

from __future__ import annotations

import jax
import numpy as np
import pytest

import deodar as dd
from deodar.compiler import executable, program
from deodar.elements.stimuli import Boost
from deodar.session.run import Run
from tests.deodar.session.models import RECORD, mixed

STEPS = 120


@pytest.fixture(scope="module")
def reference() -> dict[str, np.ndarray]:
    record = dd.simulate(mixed(), STEPS, seed=3, record=RECORD, precision="float64")
    return {path: record[path].values for path in RECORD}


def agree(record: object, reference: dict[str, np.ndarray], prefix: str = "") -> None:
    for path in RECORD:
        values = record[prefix + path].values  # type: ignore[index]
        assert np.abs(values - reference[path]).max() <= 1e-10 * max(1.0, np.abs(reference[path]).max()), path


def test_the_model_of_these_tests_is_active(reference: dict[str, np.ndarray]) -> None:
    assert (
        reference["u.activation"].max() > 1
        and reference["v.output"].std() > 0
        and reference["xi.output"].std() > 0.1
    )


def test_a_run_does_not_depend_on_the_order_of_declaration(reference: dict[str, np.ndarray]) -> None:
    agree(dd.simulate(mixed(order=-1), STEPS, seed=3, record=RECORD, precision="float64"), reference)


def test_a_run_does_not_depend_on_other_elements(reference: dict[str, np.ndarray]) -> None:
    agree(dd.simulate(mixed(extra=12), STEPS, seed=3, record=RECORD, precision="float64"), reference)


def test_a_run_does_not_depend_on_names_and_groups(reference: dict[str, np.ndarray]) -> None:
    model = mixed()
    for handle in list(model):
        model.move(handle, "inner.group")
        model.rename(handle, f"new name of {handle.element.name}")
    record = [f"inner.group.{dd.quote('new name of ' + p.split('.')[0])}.{p.split('.')[1]}" for p in RECORD]
    recorded = dd.simulate(model, STEPS, seed=3, record=record, precision="float64")
    for variable, path in zip(recorded.data_vars.values(), RECORD, strict=True):
        assert np.abs(variable.values - reference[path]).max() <= 1e-10 * max(
            1.0, np.abs(reference[path]).max()
        ), path


def test_noise_has_the_same_bits_under_another_name_order_and_batch() -> None:
    a = dd.simulate(mixed(), 20, seed=5, record=["xi.output"])["xi.output"].values
    b = dd.simulate(mixed(order=-1, extra=3), 20, seed=5, record=["xi.output"])["xi.output"].values
    c = dd.simulate(mixed(), 20, seed=5, record=["xi.output"], trials=[4, 0])["xi.output"].values
    assert np.array_equal(a, b) and np.array_equal(a, c[1]) and not np.array_equal(c[0], c[1])
    assert not np.array_equal(a, dd.simulate(mixed(), 20, seed=6, record=["xi.output"])["xi.output"].values)


@pytest.mark.parametrize("every", [1, 7, 40])
def test_a_run_does_not_depend_on_the_record_and_its_interval(
    reference: dict[str, np.ndarray], every: int
) -> None:
    record = ["slow.activation", "u.activation"]
    recorded = dd.simulate(mixed(), STEPS, seed=3, record=record, every=every, precision="float64")
    for path in record:
        assert np.array_equal(recorded["time"].values, np.arange(0, STEPS + 1, every))
        assert np.abs(recorded[path].values - reference[path][::every]).max() <= 1e-10 * 20


@pytest.mark.parametrize("records", [1, 2, 3, 100])
def test_a_record_does_not_depend_on_the_size_of_the_buffer(
    records: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    samples = 40 + records  # a program of its own
    monkeypatch.setattr(executable, "BUFFER_BYTES", records * samples * 4)
    chunk, sizes = Run._chunk, list[int]()

    def counted(self: Run, program: object, counts: dict[str, int], used: int) -> object:
        sizes.append(counts["records"])
        assert 1 <= counts["records"] <= records and len(sizes) <= 70, sizes
        return chunk(self, program, counts, used)  # type: ignore[arg-type]

    monkeypatch.setattr(Run, "_chunk", counted)
    model = dd.Model("buffer")
    u = model.add(dd.Field("u", [dd.Axis("x", 0, 10, samples=samples)], tau=10, resting_level=-5))
    model.add(Boost("b", [], amplitude=2.0)) >> u
    values = dd.simulate(model, 60, record="u.activation", every=2)["u.activation"].values
    expected = -5 + 2 * (1 - 0.9 ** np.arange(0, 61, 2))
    np.testing.assert_allclose(values, np.broadcast_to(expected[:, None], (31, samples)), rtol=1e-5)
    assert max(sizes) == min(records, max(sizes)) and sum(sizes) >= 31


def test_a_session_does_not_depend_on_its_division_into_calls(reference: dict[str, np.ndarray]) -> None:
    model = mixed()
    paths = ["u.activation", "slow.activation", "n.activation", "v.output", "u.input"]

    def same(session: dd.Session) -> None:
        for path in paths:
            assert np.abs(session.read(path) - reference[path][session.tick]).max() <= 1e-10 * 20, (
                path,
                session.tick,
            )

    one = dd.Session(model, seed=3, precision="float64")
    for _ in range(STEPS):
        one.step(1)
        same(one)
    other = dd.Session(model, seed=3, precision="float64")
    other.step(17)
    snapshot = other.snapshot()
    other.run(31)
    same(other)
    other.set("u.tau", 12)
    other.step(5)
    other.restore(snapshot)
    assert other.get("u.tau") == 10 and other.tick == 17
    other.step(50)
    same(other)
    third = dd.Session(model, seed=9, precision="float64")
    third.step(4)
    third.restore(snapshot)
    third.step(STEPS - 17)
    same(third)
    third.reset()
    assert third.tick == 0
    third.run(STEPS)
    same(third)


def test_chunks_are_bit_equal_in_float32() -> None:
    model = mixed()
    a, b = dd.Session(model, seed=1), dd.Session(model, seed=1)
    a.step(100)
    for n in (1, 2, 3, 5, 8, 13, 21, 34, 13):
        b.step(n)
    for path in RECORD:
        assert np.array_equal(a.read(path), b.read(path)), path


def test_a_trial_is_equal_alone_in_a_batch_and_in_pieces() -> None:
    """Away from a decision: one stimulus, one peak, 1,000 steps."""
    model = dd.Model("trials")
    axis = dd.Axis("x", 0, 60, samples=31)
    u = model.add(
        dd.Field("u", [axis], tau=10, kernel=[dd.Gaussian(1.0, 4)], global_inhibition=0.1, noise=0.3)
    )
    model.add(dd.GaussianStimulus("s", [axis], center=30, sigma=4, amplitude=8)) >> u

    def run(trials: list[int]) -> np.ndarray:
        return dd.simulate(
            model, 1000, record=["u.activation"], every=100, trials=trials, precision="float64"
        )["u.activation"].values

    whole = run(list(range(8)))
    for split in ([[3]], [[0, 1, 2], [3, 4, 5, 6, 7]], [[7, 3, 5]]):
        for part in split:
            assert np.abs(run(part) - whole[part]).max() <= 1e-10
    single = dd.simulate(model, 1000, record=["u.activation"], every=100, precision="float64")[
        "u.activation"
    ].values
    assert np.abs(single - whole[0]).max() <= 1e-10 and np.abs(whole[1] - whole[0]).max() > 0.1


def test_sweeps_equal_single_runs() -> None:
    model = mixed()
    model.parameter("strength", 1.0)
    model.link("n>slow.factor", "strength") if "n>slow" in model else model.link(
        '"n>slow".factor', "strength"
    )
    sweep = {"s.amplitude": [5.0, 7.0], "u.kernel.0.sigma": [3.0, 4.0], "strength": [0.5]}
    record = dd.simulate(
        model,
        60,
        seed=2,
        record=["u.activation", "slow.activation"],
        every=20,
        trials=2,
        sweep=sweep,
        precision="float64",
    )
    assert record["u.activation"].dims == (
        "s.amplitude",
        "u.kernel.0.sigma",
        "strength",
        "trial",
        "time",
        "x",
    )
    single = mixed()
    single.set("s.amplitude", 7.0)
    single.set("u.kernel.0.sigma", 3.0)
    single.set('"n>slow".factor', 0.5)
    alone = dd.simulate(
        single,
        60,
        seed=2,
        record=["u.activation", "slow.activation"],
        every=20,
        trials=[1],
        precision="float64",
    )
    for path in ("u.activation", "slow.activation"):
        point = record[path].values[1, 0, 0, 1]
        assert np.abs(point - alone[path].values[0]).max() <= 1e-10


def test_both_precisions_run_in_one_process_without_a_change_of_flags() -> None:
    before = {
        name: getattr(jax.config, name)
        for name in ("jax_enable_x64", "jax_compilation_cache_dir", "jax_default_matmul_precision")
    }
    model = mixed()
    narrow, wide = dd.Session(model, seed=1), dd.Session(model, seed=1, precision="float64")
    for _ in range(5):
        narrow.step(10)
        wide.step(10)
    a, b = narrow.read("u.activation"), wide.read("u.activation")
    assert a.dtype == np.float32 and b.dtype == np.float64
    assert 0 < np.abs(a - b).max() < 1e-3
    assert before == {name: getattr(jax.config, name) for name in before}
    assert jax.numpy.ones(1).dtype == np.float32


@pytest.mark.parametrize("trials", [None, 3])
def test_noise_kept_for_the_next_step_has_the_bits_of_noise_drawn_in_every_step(
    monkeypatch: pytest.MonkeyPatch, trials: int | None
) -> None:
    model = mixed()
    records = []
    for cells in (1, 10**9):
        monkeypatch.setattr(program, "BLOCKS_FROM", cells)
        executable._shared.cache_clear()
        record = dd.simulate(dd.Model(document=model.document), 31, trials=trials, seed=3, record=RECORD)
        records.append({path: record[path].values for path in RECORD})
    executable._shared.cache_clear()
    for path in RECORD:
        np.testing.assert_array_equal(records[0][path], records[1][path])


@pytest.mark.parametrize("every", [1, 2])
def test_noise_drawn_in_pairs_is_the_same_in_any_chunks(every: int) -> None:
    """In a field so large that two steps share one draw, single steps, odd pieces and one run give the
    same bits.
    """
    axes = [dd.Axis("x", 0, 60, samples=60), dd.Axis("y", 0, 50, samples=50)]
    model = dd.Model("large")
    u = model.add(dd.Field("u", axes, kernel=[dd.Gaussian(5, 3, normalized=True)], noise=1.0))
    v = model.add(dd.Field("v", axes, noise=0.5), ticks=every)
    u >> dd.Gain(0.5) >> v
    sessions = [dd.Session(model, seed=5) for _ in range(3)]
    for session, pieces in zip(sessions, ([31], [1] * 31, [3, 1, 20, 7]), strict=True):
        for n in pieces:
            session.step(n)
    seen = [[s.read(f"{name}.activation") for name in "uv"] for s in sessions]
    for other in seen[1:]:
        for a, b in zip(seen[0], other, strict=True):
            np.testing.assert_array_equal(a, b)
    exact = dd.Session(model, seed=5, precision="float64")
    exact.step(31)
    np.testing.assert_allclose(seen[0][0], exact.read("u.activation"), atol=1e-3)
