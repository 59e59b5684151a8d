"""Runs that write their record while they run, and are resumed."""

from __future__ import annotations

import dataclasses as dc
import itertools
import json
import pickle
from collections.abc import Callable, Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar.batch import piece_record, run_file
from deodar.batch.compute import compute, watching
from deodar.batch.piece_record import PieceEnded, PieceMessage, RecordedPiece
from deodar.batch.pieces import EMPTY, PieceResult
from deodar.batch.run_file import RunOutput
from deodar.batch.simulation_request import SimulationRequest
from deodar.cli import main
from deodar.errors import Interrupted, NotFinite, OutputExists, RecordError
from deodar.recording import files
from deodar.recording.record import about
from deodar.session import checkpoint
from tests.deodar.recording.models import model
from tests.deodar.worlds.test_recorded_run import driving


def stopping(after: int) -> Callable[[int], None]:
    """Return a function that stops a run after that number of steps."""

    def stop(done: int) -> None:
        if done >= after:
            raise KeyboardInterrupt

    return stop


def stopped(given: dict[str, Any], after: int) -> dict[str, Any]:
    """Return the arguments of a run that stops after that number of steps."""
    return given | {"on": dc.replace(given.get("on", dd.Resources()), progress=stopping(after))}


@pytest.fixture(autouse=True)
def short_chunks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("deodar.session.run.CHUNK_SECONDS", 0.0)


CASES: dict[str, dict[str, Any]] = {
    "single": {},
    "trials": {"trials": [4, 2, 7]},
    "sweep": {"sweep": {"s.amplitude": [1.0, 2.0], "u.tau": [10.0, 20.0]}},
    "pieces": {"trials": 3, "sweep": {"s.amplitude": [1.0, 2.0]}, "on": dd.Resources(batch=2)},
    "workers": {"trials": 4, "on": dd.Resources(workers=2)},
    "end": {"record": None, "every": None},
    "double": {"precision": "float64"},
}


@pytest.mark.parametrize("case", CASES)
def test_a_record_in_a_file_equals_the_one_in_memory(case: str, tmp_path: Path) -> None:
    options = {"record": ["u", "n.output"], "every": 5, "seed": 3, **CASES[case]}
    memory = dd.simulate(model(), 40, **options)
    stored = dd.simulate(model(), 40, out=tmp_path / "run", **options)
    assert files.load_record(tmp_path / "run").identical(memory) and stored.load().identical(memory)
    assert dd.load(tmp_path / "run" / "model.json").document == model().document


def test_a_wall_clock_that_is_set_back_delays_no_state(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    back = itertools.count(1_700_000_000.0, -3600.0)
    monkeypatch.setattr("time.time", lambda: next(back))
    monkeypatch.setattr(piece_record, "CHECKPOINT_SECONDS", 1e-9)
    stored: list[int] = []

    def note(done: int) -> None:
        state = tmp_path / "run" / "record.zarr" / run_file.CHECKPOINT
        stored.append(checkpoint.read(state)[0]["steps"] if state.exists() else 0)

    dd.simulate(
        model(), 20, record="u", every=5, seed=3, out=tmp_path / "run", on=dd.Resources(progress=note)
    )
    assert len(stored) > 3 and stored == sorted(set(stored)) and stored[-1] > 0


@pytest.mark.parametrize("case", [case for case in CASES if case not in ("workers", "end")])
def test_a_stopped_run_is_resumed_to_the_same_record(case: str, tmp_path: Path) -> None:
    options = {"record": ["u", "n.output"], "every": 5, "seed": 3, **CASES[case]}
    memory = dd.simulate(model(), 40, **options)
    steps = 40 * (3 if case == "pieces" else 1)
    for k, after in enumerate((steps // 4, steps // 2, 3 * steps // 4)):
        with pytest.raises(Interrupted) as caught:
            if k:
                dd.resume(tmp_path / "run", on=dd.Resources(progress=stopping(after)))
            else:
                dd.simulate(model(), 40, out=tmp_path / "run", **stopped(options, after))
        assert about(caught.value.data)["complete"] is False
    assert dd.resume(tmp_path / "run").load().identical(memory)


def test_a_run_that_is_stopped_before_its_only_sample_leaves_nothing_to_resume(tmp_path: Path) -> None:
    options = {"seed": 3, **CASES["end"]}
    with pytest.raises(Interrupted) as caught:
        dd.simulate(model(), 40, out=tmp_path / "run", **stopped(options, 10))
    assert caught.value.data is None and not list(tmp_path.iterdir())
    stored = dd.simulate(model(), 40, out=tmp_path / "run", **options)
    assert stored.load().identical(dd.simulate(model(), 40, **options))


@pytest.fixture
def sent_here(monkeypatch: pytest.MonkeyPatch) -> None:
    """Compute the pieces of workers in this process, and receive pickled what they send."""

    def run(
        workers: int,
        model: dd.Model,
        world: dd.World | None,
        pieces: Sequence[SimulationRequest],
        out: RunOutput,
        between: Callable[[int], None],
    ) -> list[PieceResult | None]:
        parts: list[PieceResult | None] = [EMPTY if k in out.done else None for k in range(len(pieces))]
        for k in [k for k, part in enumerate(parts) if part is None]:

            def send(message: PieceMessage, k: int = k) -> None:
                out.receive(k, pickle.loads(pickle.dumps(message)), beside=True)

            part = RecordedPiece(pickle.loads(pickle.dumps(out.part(k))), send)
            try:
                job = watching(pieces[k], lambda done, k=k: between(k * 40 + done))
                parts[k] = compute(model, job, world, out=part)
            except Interrupted as error:
                parts[k] = PieceResult(error.data, False)
                break
        return parts

    monkeypatch.setattr("deodar.batch.simulate.in_workers", run)


@pytest.mark.usefixtures("sent_here")
def test_pieces_of_workers_are_resumed_from_states_of_their_own(tmp_path: Path) -> None:
    options: dict[str, Any] = {"record": ["u", "n.output"], "every": 5, "seed": 3, **CASES["workers"]}
    memory = dd.simulate(model(), 40, **options | {"on": dd.Resources(batch=2)})
    record = tmp_path / "run" / "record.zarr"
    with pytest.raises(Interrupted) as caught:
        dd.simulate(model(), 40, out=tmp_path / "run", **stopped(options, 20))
    activation = caught.value.data["u.activation"].values
    assert np.isfinite(activation[:2, :4]).all() and about(caught.value.data)["complete"] is False
    assert checkpoint.read(record / run_file.PIECE_CHECKPOINT.format(0))[0]["steps"] == 20
    begun: list[int] = []

    def note(done: int) -> None:
        begun.append(done)
        stopping(60)(done)

    with pytest.raises(Interrupted):
        dd.resume(tmp_path / "run", on=dd.Resources(progress=note))
    assert begun[0] > 20, "it continues from the stored state"
    assert sorted(p.name for p in record.glob("state*")) == ["state-1.npz", "state.npz"]
    resumed = dd.resume(tmp_path / "run").load()
    assert [p.name for p in record.glob("state*")] == ["state.npz"]
    for name in memory.variables:
        assert resumed[name].values.tobytes() == memory[name].values.tobytes()


@pytest.mark.usefixtures("sent_here")
def test_a_run_killed_before_a_worker_reports_its_end_is_resumed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    options: dict[str, Any] = {"record": ["u"], "every": 5, "seed": 3, **CASES["workers"]}
    memory = dd.simulate(model(), 40, **options | {"on": dd.Resources(batch=2)})
    receive = RunOutput.receive

    def killed(out: RunOutput, number: int, message: PieceMessage, beside: bool) -> None:
        if isinstance(message, PieceEnded):
            raise InterruptedError
        receive(out, number, message, beside)

    with monkeypatch.context() as changed:
        changed.setattr(RunOutput, "receive", killed)
        with pytest.raises(InterruptedError):
            dd.simulate(model(), 40, out=dd.Output(tmp_path / "run", snapshots=20), **options)
    assert checkpoint.read(tmp_path / "run/record.zarr/state-0.npz")[0]["steps"] == 40
    resumed = dd.resume(tmp_path / "run").load()
    assert resumed["u.activation"].values.tobytes() == memory["u.activation"].values.tobytes()


@pytest.mark.usefixtures("sent_here")
def test_the_cores_of_this_process_do_not_matter_to_a_run_in_workers(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    options: dict[str, Any] = {"record": ["u"], "every": 5, "seed": 3, **CASES["workers"]}
    with monkeypatch.context() as elsewhere:
        elsewhere.setattr("deodar.recording.provenance.cores", lambda: 1)
        with pytest.raises(Interrupted):
            dd.simulate(model(), 40, out=tmp_path / "run", **stopped(options, 20))
    monkeypatch.setattr("deodar.recording.provenance.cores", lambda: 7)
    assert about(dd.resume(tmp_path / "run"))["complete"] is True


@pytest.mark.usefixtures("sent_here")
def test_samples_of_workers_after_their_states_are_dropped_where_differences_are_accepted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    options: dict[str, Any] = {"record": ["u"], "every": 5, "seed": 3, **CASES["workers"]}
    state = tmp_path / "run" / "record.zarr" / run_file.PIECE_CHECKPOINT.format(1)
    with monkeypatch.context() as elsewhere:
        elsewhere.setattr("deodar.recording.provenance.machine", lambda: "a toaster")
        with pytest.raises(Interrupted):
            dd.simulate(model(), 40, out=tmp_path / "run", **stopped(options, 50))
        early = state.read_bytes()
        with pytest.raises(Interrupted):
            dd.resume(tmp_path / "run", on=dd.Resources(progress=stopping(70)))
    state.write_bytes(early)
    assert finite(tmp_path / "run", 6) == 4
    with pytest.raises(Interrupted):
        dd.resume(tmp_path / "run", accept=lambda differences: True, on=dd.Resources(progress=stopping(56)))
    assert finite(tmp_path / "run", 3) == 4 and finite(tmp_path / "run", 6) == 2


def test_a_run_in_a_world_is_resumed(tmp_path: Path) -> None:
    options = {"record": ["eyes", "u", "left.output"], "every": 32, "seed": 4}
    memory = dd.simulate(driving(), 1600, world=dd.Arena("blocks"), **options)
    with pytest.raises(Interrupted):
        dd.simulate(
            driving(),
            1600,
            world=dd.Arena("blocks"),
            out=tmp_path / "run",
            on=dd.Resources(progress=stopping(40)),
            **options,
        )
    assert dd.resume(tmp_path / "run").load().identical(memory)


def test_a_complete_run_becomes_longer(tmp_path: Path) -> None:
    options = {"record": ["u"], "every": 5, "seed": 3}
    dd.simulate(model(), 20, out=tmp_path / "run", **options)
    with pytest.raises(RecordError, match="is complete"):
        dd.resume(tmp_path / "run")
    with pytest.raises(RecordError, match="shorter"):
        dd.resume(tmp_path / "run", duration=10)
    longer = dd.resume(tmp_path / "run", duration=40)
    assert longer.load().identical(dd.simulate(model(), 40, **options))


def test_a_run_that_is_made_longer_remembers_it_when_it_is_stopped(tmp_path: Path) -> None:
    options = {"record": ["u"], "every": 5, "seed": 3}
    dd.simulate(model(), 20, out=tmp_path / "run", **options)
    with pytest.raises(Interrupted):
        dd.resume(tmp_path / "run", duration=60, on=dd.Resources(progress=stopping(30)))
    stated = about(dd.open_record(tmp_path / "run"))
    assert stated["complete"] is False and stated["duration"] == 60
    assert dd.resume(tmp_path / "run").load().identical(dd.simulate(model(), 60, **options))


def test_a_resumed_run_that_is_stopped_keeps_the_samples_that_were_there(tmp_path: Path) -> None:
    options = {"record": ["u"], "every": 1, "seed": 3}
    with pytest.raises(Interrupted):
        dd.simulate(model(), 40, out=tmp_path / "run", **stopped(options, 30))
    before = dd.open_record(tmp_path / "run").sizes["time"]
    (tmp_path / "run" / "record.zarr" / run_file.CHECKPOINT).unlink()
    with pytest.raises(Interrupted):
        dd.resume(tmp_path / "run", on=dd.Resources(progress=stopping(5)))
    stored = files.load_record(tmp_path / "run")
    assert stored.sizes["time"] == before
    assert stored.drop_attrs().identical(dd.simulate(model(), before - 1, **options).drop_attrs())


def test_a_record_that_was_saved_is_not_resumed(tmp_path: Path) -> None:
    record = dd.simulate(model(), 20, record="u", every=5)
    for name in ("run.zarr", "run.nc"):
        dd.save_record(record, tmp_path / name)
        with pytest.raises(RecordError, match="cannot be resumed"):
            dd.resume(tmp_path / name, duration=40)


def test_a_state_of_another_run_is_refused(tmp_path: Path) -> None:
    for name, seed in (("run", 3), ("other", 4)):
        with pytest.raises(Interrupted):
            dd.simulate(
                model(),
                40,
                record="u",
                every=5,
                seed=seed,
                out=tmp_path / name,
                on=dd.Resources(progress=stopping(10)),
            )
    state = Path("record.zarr") / run_file.CHECKPOINT
    (tmp_path / "run" / state).write_bytes((tmp_path / "other" / state).read_bytes())
    with pytest.raises(RecordError, match="of another run"):
        dd.resume(tmp_path / "run")


def test_a_run_with_conditions_alone_states_where_it_ended(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    growing = model()
    growing.set({"u.sigmoid": dd.Linear(), "u.kernel.0.amplitude": 100.0})
    with pytest.raises(NotFinite, match="is kept") as caught:
        dd.simulate(growing, 40, record="u,when=crossing", every=1, out=tmp_path / "run")
    assert "--resume" not in str(caught.value)


def test_a_stop_before_the_first_step_samples_once(tmp_path: Path) -> None:
    options = {"record": ["n", "u.output,when=peak"], "every": 10, "seed": 3}
    with pytest.raises(Interrupted):
        dd.simulate(model(), 40, out=tmp_path / "run", **stopped(options, 0))
    resumed, whole = dd.resume(tmp_path / "run"), dd.simulate(model(), 40, out=tmp_path / "whole", **options)
    assert resumed["u.output.time"].values.tolist() == whole["u.output.time"].values.tolist()


def test_a_run_in_pieces_does_not_become_longer(tmp_path: Path) -> None:
    dd.simulate(model(), 20, record="u", every=5, trials=4, out=tmp_path / "run", on=dd.Resources(batch=2))
    with pytest.raises(RecordError, match="several pieces"):
        dd.resume(tmp_path / "run", duration=40)


def test_a_run_that_was_killed_before_its_first_state_begins_again(tmp_path: Path) -> None:
    options = {"record": ["u"], "every": 5, "seed": 3}
    with pytest.raises(Interrupted):
        dd.simulate(model(), 40, out=tmp_path / "run", **stopped(options, 10))
    (tmp_path / "run" / "record.zarr" / run_file.CHECKPOINT).unlink()
    assert dd.resume(tmp_path / "run").load().identical(dd.simulate(model(), 40, **options))


def test_other_versions_are_an_error_unless_accepted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    with monkeypatch.context() as elsewhere:
        elsewhere.setattr("deodar.recording.provenance.machine", lambda: "a toaster")
        with pytest.raises(Interrupted):
            dd.simulate(
                model(), 40, record="u", every=5, out=tmp_path / "run", on=dd.Resources(progress=stopping(10))
            )
    with pytest.raises(RecordError, match="a toaster then"):
        dd.resume(tmp_path / "run")
    assert main(["run", str(tmp_path / "run"), "--resume"]) == 1
    assert "a toaster then" in capsys.readouterr().err
    assert main(["run", str(tmp_path / "run"), "--resume", "--yes"]) == 0
    assert files.load_record(tmp_path / "run").sizes["time"] == 9


def finite(path: Path, number: int) -> int:
    """Return how many copies have a sample of that number."""
    values = files.load_record(path)["u.activation"].values[..., number : number + 1, :]
    return int(np.isfinite(values).all(-1).sum())


@pytest.mark.parametrize("case", ["single", "pieces"])
@pytest.mark.parametrize("accepted", [False, True])
def test_samples_after_the_stored_state_are_dropped_where_differences_are_accepted(
    case: str, accepted: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The state of the run is that of a step before its last samples, as after a kill."""
    options: dict[str, Any] = {"record": "u", "every": 5, "seed": 3, **CASES[case]}
    path, pieces = tmp_path / "run", 2 if case == "pieces" else 1
    with monkeypatch.context() as elsewhere:
        if accepted:
            elsewhere.setattr("deodar.recording.provenance.machine", lambda: "a toaster")
        with pytest.raises(Interrupted):
            dd.simulate(model(), 40, out=path, **stopped(options, 40 * (pieces - 1) + 10))
        state = (path / "record.zarr" / run_file.CHECKPOINT).read_bytes()
        with pytest.raises(Interrupted):
            dd.resume(path, on=dd.Resources(progress=stopping(40 * (pieces - 1) + 30)))
    (path / "record.zarr" / run_file.CHECKPOINT).write_bytes(state)
    later = finite(path, 6)
    with pytest.raises(Interrupted):
        dd.resume(
            path, accept=lambda differences: True, on=dd.Resources(progress=stopping(40 * (pieces - 1) + 16))
        )
    assert finite(path, 3) == later
    assert finite(path, 6) == (later - (2 if pieces == 2 else 1) if accepted else later)


def test_copies_that_diverge_are_nan_in_the_file(tmp_path: Path) -> None:
    diverging = model()
    options = {"record": ["u"], "every": 5, "sweep": {"u.kernel.0.amplitude": [1.0, 3e38, 2.0]}}
    with pytest.warns(dd.errors.RunWarning):
        memory = dd.simulate(diverging, 40, **options)
    with pytest.warns(dd.errors.RunWarning):
        stored = dd.simulate(diverging, 40, out=tmp_path / "run", **options)
    assert stored.load().identical(memory) and np.isnan(stored["u.activation"].values[1]).all()


def test_copies_that_diverged_before_a_stop_are_nan_after_it(tmp_path: Path) -> None:
    amplitudes = {"sweep": {"u.kernel.0.amplitude": [1.0, 3e38, 2.0, 1.5]}, "on": dd.Resources(batch=2)}
    options: dict[str, Any] = {"record": ["u"], "every": 5, **amplitudes}
    with pytest.warns(dd.errors.RunWarning):
        memory = dd.simulate(model(), 40, **options)
    with pytest.raises(Interrupted):
        dd.simulate(model(), 40, out=tmp_path / "run", **stopped(options, 60))
    with pytest.warns(dd.errors.RunWarning):
        resumed = dd.resume(tmp_path / "run")
    assert resumed.load().identical(memory) and np.isnan(resumed["u.activation"].values[1]).all()


def test_a_batch_whose_copies_all_diverge_before_its_only_sample_is_nan_in_the_file(tmp_path: Path) -> None:
    diverging = model()
    diverging.set({"u.sigmoid": dd.Linear()})
    with pytest.raises(NotFinite, match="infinite"):
        dd.simulate(diverging, 40, sweep={"u.kernel.0.amplitude": [1e9, 1e10]}, out=tmp_path / "run")
    record = dd.open_record(tmp_path / "run")
    assert about(record)["complete"] is True and all(record["diverged"].values)


def test_a_run_that_diverges_keeps_its_record_until_then(tmp_path: Path) -> None:
    growing = model()
    growing.set({"u.sigmoid": dd.Linear(), "u.kernel.0.amplitude": 100.0})  # grows without bound
    with pytest.raises(NotFinite, match="is kept"):
        dd.simulate(growing, 40, record="u", every=1, out=tmp_path / "run")
    record = dd.open_record(tmp_path / "run")
    assert about(record)["complete"] is False and 0 < record.sizes["time"] < 41


def test_an_existing_run_is_replaced_only_with_force(tmp_path: Path) -> None:
    out = tmp_path / "run"
    dd.simulate(model(), 20, record="u", every=5, out=out)
    with pytest.raises(OutputExists):
        dd.simulate(model(), 40, record="u", every=5, out=out)
    assert dd.open_record(tmp_path / "run").sizes["time"] == 5
    dd.simulate(model(), 40, record="u", every=5, out=dd.Output(out, force=True))
    assert dd.open_record(tmp_path / "run").sizes["time"] == 9


def test_a_bare_record_has_no_model_file(tmp_path: Path) -> None:
    dd.simulate(model(), 20, record="u", every=5, out=tmp_path / "run.zarr")
    assert [p.name for p in tmp_path.iterdir()] == ["run.zarr"]
    assert files.load_record(tmp_path / "run.zarr").sizes["time"] == 5


def test_a_bare_record_of_the_command_has_no_model(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    dd.save(model(), "m.json")
    command = ["run", "m.json", "--duration", "20", "--record", "u", "--out", "x.zarr", "--json"]
    assert main(command) == 0
    assert "model" not in json.loads(capsys.readouterr().out)
    assert main([*command, "--force"]) == 0
    with pytest.raises(SystemExit):
        main([*command, "--force", "--format", "netcdf"])
    assert "--format netcdf cannot be given" in capsys.readouterr().err


def test_the_command_resumes_and_answers_in_json(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(Interrupted):
        dd.simulate(
            model(), 40, record="u", every=5, out=tmp_path / "run", on=dd.Resources(progress=stopping(10))
        )
    monkeypatch.chdir(tmp_path)
    assert main(["run", "run", "--resume", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["complete"] is True and answer["variables"]["u.activation"]["time"] == 9
    assert main(["run", "run", "--resume", "--duration", "60"]) == 0
    assert "13 times" in capsys.readouterr().out
    with pytest.raises(SystemExit):
        main(["run", "run", "--resume", "--seed", "4"])
    assert "--seed cannot be given" in capsys.readouterr().err


def test_states_are_stored_as_often_as_requested(monkeypatch: pytest.MonkeyPatch) -> None:
    part: Any = SimpleNamespace(begun=False, snapshots=20.0)
    run: Any = SimpleNamespace(program=SimpleNamespace(across=False))
    piece = RecordedPiece(part, lambda message: None)
    piece.plan = SimpleNamespace(sampling=SimpleNamespace(dt=0.5))  # type: ignore[assignment]
    stored = list[int]()

    def save(piece: RecordedPiece, run: Any, done: int) -> None:
        stored.append(done)
        piece._saved_at = done

    monkeypatch.setattr(RecordedPiece, "_save", save)
    for done in range(10, 130, 10):
        piece._save_if_due(run, done)  # type: ignore[arg-type]
    assert stored == [40, 80, 120]
