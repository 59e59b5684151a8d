"""A page opens, edits, runs and saves an experiment, over a real socket."""

from __future__ import annotations

import asyncio
import contextlib
import json
import threading
from collections.abc import AsyncIterator, Awaitable, Callable
from pathlib import Path
from typing import Any, cast

import msgspec
import numpy as np
import pytest

import deodar as dd
from deodar import codec
from deodar.errors import DeodarError
from deodar.experiments import row_line
from deodar.experiments.results import stored
from deodar_studio.experiment.experiment_run import ExperimentRun
from deodar_studio.experiment.open_experiment import OpenExperiment
from deodar_studio.experiment.run_place import RunPlace
from deodar_studio.files import state_store
from deodar_studio.messages.message import union
from deodar_studio.messages.to_page import Answer, ExperimentView
from deodar_studio.pages import hub
from deodar_studio.project.confirmation import ConfirmationRequired
from deodar_studio.requests.request import MESSAGES
from deodar_studio.web.connection import PageConnection
from tests.deodar.experiments.calls import changed
from tests.deodar_studio.page import WAIT, Page, play, studio


def two_targets() -> dd.Experiment:
    """The experiment of the manual."""
    x = dd.Axis("x", 0, 100, samples=101)
    model = dd.Model("two targets")
    u = model.add(
        dd.Field(
            "u", [x], tau=20, resting_level=-5, kernel=[dd.Gaussian(1.2, 5)], global_inhibition=0.6, noise=1.0
        )
    )
    for name in ("left", "right"):
        model.add(dd.GaussianStimulus(name, [x], sigma=5, amplitude=5, windows=[(100, 600)])) >> u
    model.add(dd.GaussianStimulus("preshape", [x], sigma=5, amplitude=1)) >> u
    near = {"left.center": 46, "right.center": 54, "preshape.center": 46}
    far = {"left.center": 35, "right.center": 65, "preshape.center": 35}
    return dd.Experiment(
        "two targets",
        model,
        dd.TrialPlan(
            600,
            events=[dd.Appears("detected", "u")],
            measures=[dd.Measure("place", "u.activation", "place", threshold=-2.5)],
        ),
        trials=25,
        factors=[
            dd.Factor("distance", {"near": near, "far": far}),
            dd.Factor("preshape", [0.0, 1.0], "preshape.amplitude"),
        ],
    )


def few(trials: int = 3, **options: Any) -> dd.Experiment:
    """The same with few trials, which end soon."""
    return changed(two_targets(), trials=trials, limit=150, **options)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    root = tmp_path / "root"
    root.mkdir()
    return root


def experiment(p: Page) -> dict[str, Any]:
    return p.said["experiment"]


def rows(p: Page) -> list[dict[str, Any]]:
    """The rows of the present run that the page has received."""
    number = experiment(p)["run"]["number"]
    return [row for m in p.all if m["type"] == "trial_rows" and m["run"] == number for row in m["rows"]]


async def ended(p: Page) -> None:
    await p.until(lambda: (experiment(p)["run"] or {}).get("state") not in (None, "running"))
    await p.until(lambda: len(rows(p)) == experiment(p)["run"]["rows"])


def test_an_experiment_file_opens_with_its_model_and_runs_in_a_worker(folder: Path) -> None:
    few().save(folder / "two-targets.json")

    async def scene(p: Page) -> None:
        await p.open("open_experiment", path="two-targets.json")
        assert p.document["title"] == "two targets" and p.document["file"] == "two-targets.model.json"
        view = experiment(p)
        assert view["file"] == "two-targets.json" and not view["unsaved"] and not view["problems"]
        assert view["trials"] == 12 and list(view["data"]["conditions"]) == ["detected"]
        await p.do("run_experiment")
        await ended(p)
        run = experiment(p)["run"]
        assert (run["state"], run["rows"], run["folder"]) == ("complete", 12, "two_targets-001")
        assert rows(p) == stored(folder / "two_targets-001")[1]

    with studio(folder) as address:
        play(address, scene)
    table = dd.load_results(folder / "two_targets-001")
    expected = few().run(folder / "by script", on=dd.Resources(workers=1))
    assert table.sizes["trial"] == 12
    assert np.array_equal(table["place"], expected["place"], equal_nan=True)


def test_the_example_of_the_manual_built_by_messages_is_written_as_python_writes_it(
    folder: Path, tmp_path: Path
) -> None:
    expected = tmp_path / "python"
    expected.mkdir()
    two_targets().save(expected / "two-targets.json")
    model = (expected / "two-targets.model.json").read_text(encoding="utf-8")

    async def scene(p: Page) -> None:
        await p.open("open_text", name="two targets.json", text=model)
        await p.do("new_experiment")
        data: dict[str, Any] = experiment(p)["data"]
        assert data["name"] == "two targets"

        async def edit(**changes: Any) -> None:
            data.update(changes)
            await p.do("edit_experiment", data=data, version=experiment(p)["version"])

        # a page does not write 0.0, and adds keys in the order of the clicks
        await edit(measures={"place": {"kind": "Measure", "of": "u.activation"}})
        await edit(trials=25, limit=600)
        near = {"left.center": 46, "right.center": 54, "preshape.center": 46}
        far = {"left.center": 35, "right.center": 65, "preshape.center": 35}
        await edit(factors={"distance": {"levels": {"near": near, "far": far}}})
        await edit(factors={**data["factors"], "preshape": {"path": "preshape.amplitude", "levels": [0, 1]}})
        await edit(conditions={"detected": {"kind": "Appears"}})
        [problem] = experiment(p)["problems"]
        assert (problem["where"], "'field'" in problem["what"]) == ("conditions.detected", True)
        await edit(conditions={"detected": {"kind": "Appears", "field": "u", "threshold": 0}})
        place = {"kind": "Measure", "threshold": -2.5, "reduce": "place", "of": "u.activation"}
        await edit(measures={"place": place})
        assert experiment(p)["problems"] == [] and experiment(p)["trials"] == 100
        assert experiment(p)["unsaved"]
        answer = await p.do("save_experiment", path="two-targets.json")
        assert answer["file"] == "two-targets.json" and not experiment(p)["unsaved"]

    with studio(folder) as address:
        play(address, scene)
    for name in ("two-targets.json", "two-targets.model.json"):
        assert (folder / name).read_bytes() == (expected / name).read_bytes()


def test_a_stopped_run_continues_and_so_does_one_of_a_studio_that_ended(folder: Path) -> None:
    slow = few(4, actions=[dd.Set(50, "u.kernel.0.sigma", 4.9)])
    assert not slow.setup().batched, "its trials run one by one"
    slow.save(folder / "slow.json")
    done: list[int] = []

    async def begin(p: Page) -> None:
        await p.open("open_experiment", path="slow.json")
        await p.do("run_experiment")
        await p.until(lambda: experiment(p)["run"]["rows"] >= 2)
        await p.do("stop_experiment")
        await ended(p)
        assert experiment(p)["run"]["state"] == "stopped"
        done.append(experiment(p)["run"]["rows"])
        await p.do("run_experiment")
        await p.until(lambda: experiment(p)["run"]["rows"] > done[0])
        assert experiment(p)["run"]["folder"] == "two_targets-001"

    async def resume(p: Page) -> None:
        await p.open("open_file", path="two_targets-001/experiment.json")
        before = experiment(p)["run"]
        assert before["state"] == "stopped" and done[0] < before["rows"] < 16
        await p.until(lambda: len(rows(p)) == before["rows"])
        await p.do("run_experiment")
        await ended(p)
        assert (experiment(p)["run"]["state"], len(rows(p))) == ("complete", 16)

    with studio(folder) as address:
        play(address, begin)
    with studio(folder) as address:
        play(address, resume)
    expected = slow.run(folder / "by script", on=dd.Resources(workers=1))
    assert np.array_equal(dd.load_results(folder / "two_targets-001")["duration"], expected["duration"])


@pytest.mark.parametrize("actions", [[], [dd.Set(50, "u.kernel.0.sigma", 4.9)]], ids=["batch", "one by one"])
def test_a_row_opens_the_record_of_its_trial_which_gives_the_same_row(
    folder: Path, actions: list[dd.Set]
) -> None:
    few(2, actions=actions).save(folder / "two-targets.json")

    async def scene(p: Page) -> None:
        await p.open("open_experiment", path="two-targets.json")
        await p.do("run_experiment")
        await ended(p)
        await p.runs()
        await p.do("step", n=70)
        await p.until(lambda: p.clock["time"] == 70)
        await p.do("set", element=p.element("left"), parameter="sigma", value=7.5)
        await p.do("repeat_trial", trial=5)
        record = p.document["record"]
        assert record["path"] == "two_targets-001/repeats/000005.nc"
        assert experiment(p)["repeated"] == 5
        await p.until(lambda: experiment(p)["problems"] == [])
        recording = dd.open_record(folder / record["path"])
        row = next(row for row in rows(p) if row["trial"] == 5)
        shown = np.argmax(recording["u.activation"].values.max(axis=1) > 0)
        if row["events"]["detected"] is not None:
            assert recording["time"].values[shown] == row["events"]["detected"]
        assert float(recording["time"][-1]) == row["duration"]
        assert json.loads(recording.attrs["deodar"])["levels"] == row["levels"]
        center = p.document["elements"][1]["values"]["center"]
        assert p.document["elements"][1]["path"] == "left"
        assert center == {"near": 46, "far": 35}[row["levels"]["distance"]]
        await p.do("leave_trial")
        await p.runs()
        assert "record" not in p.document or p.document["record"] is None
        assert p.document["file"] == "two-targets.model.json" and experiment(p)["repeated"] is None
        await p.until(lambda: p.clock["time"] == 70)  # the run stands where it was
        assert not p.clock["running"]
        assert p.document["elements"][1]["values"]["sigma"] == 7.5 and p.document["unsaved"]
        await p.do("step", n=5)
        await p.until(lambda: p.clock["time"] == 75)

    with studio(folder) as address:
        play(address, scene)


def test_a_row_whose_record_is_in_a_store_is_repeated(folder: Path) -> None:
    few(1, watch=["u"], every=5.0).run(
        folder / "results", on=dd.Resources(workers=1), records=folder / "store"
    )
    row = json.loads((folder / "results" / "trials.jsonl").read_text().splitlines()[2])
    assert row["trial"] == 1 and row["record"]["object"].startswith("records/0000/")

    async def scene() -> None:
        async with desk(folder) as d:
            await d.do("open_experiment", path="results/experiment.json")
            await d.do("repeat_trial", trial=1)
            assert d.hub.project.record.reader is not None

    asyncio.run(scene())
    with dd.open_records(folder / "store") as records:
        repeated = dd.load_record(folder / "results" / "repeats" / "000001.nc")
        assert records[1]["u.activation"].equals(repeated["u.activation"])


def test_a_trial_that_was_repeated_is_compared_with_its_own_row(folder: Path) -> None:
    run = ExperimentRun(cast("Any", None), folder, lambda: None)
    run.rows = [{"trial": trial, "place": 10.0 * trial} for trial in range(3)]
    record = folder / "repeats" / "000001.nc"
    record.parent.mkdir()
    record.touch()
    row = record.with_suffix(".json")
    row.write_text(codec.line({"trial": 1, "place": 10.0}), encoding="utf-8")
    assert run.repeat(1) == record
    row.write_text(codec.line({"trial": 1, "place": 20.0}), encoding="utf-8")
    with pytest.raises(DeodarError, match="trial 1 gives another row"):
        run.repeat(1)
    with pytest.raises(DeodarError, match="no row of trial 3"):
        run.repeat(3)


@pytest.mark.parametrize("repeated", [False, True], ids=["never repeated", "repeated before"])
def test_a_stored_row_that_was_changed_is_refused_on_replay(folder: Path, repeated: bool) -> None:
    few(1).run(folder / "results")
    file = folder / "results" / "trials.jsonl"

    async def scene() -> None:
        async with desk(folder) as d:
            await d.do("open_experiment", path="results/experiment.json")
            if repeated:
                await d.do("repeat_trial", trial=2)
                await d.do("leave_trial")
            await d.do("close_experiment")
            lines = file.read_bytes().splitlines(keepends=True)
            changed = [
                row_line.write(row | {"duration": row["duration"] - 1}, True)
                if row.get("trial") == 2
                else line
                for line in lines
                for row in [row_line.read(line, True)]
            ]
            assert changed != lines
            file.write_bytes(b"".join(changed))
            await d.do("open_experiment", path="results/experiment.json")
            with pytest.raises(DeodarError, match="trial 2 gives another row than the stored one"):
                await d.do("repeat_trial", trial=2)
            assert d.hub.project.record.reader is None
            assert not list((folder / "results" / "repeats").glob("*2.*"))
            await d.do("repeat_trial", trial=1)
            assert d.hub.project.record.reader is not None

    asyncio.run(scene())


def test_what_cannot_be_done_is_refused(folder: Path, tmp_path: Path) -> None:
    few().save(folder / "two-targets.json")
    (tmp_path / "outside.json").write_text((folder / "two-targets.json").read_text())
    (folder / "leaves.json").write_text(
        json.dumps({"experiment": 3, "name": "a", "model": "../outside.json", "limit": 1})
    )

    async def problem(p: Page, type: str, **message: Any) -> str:
        answer = await p.ask(type, **message)
        return " ".join(f"{q['where']} {q['what']}" for q in answer["problems"])

    async def scene(p: Page) -> None:
        assert "no document is open" in await problem(p, "new_experiment")
        assert "no rows" in await problem(p, "repeat_trial", trial=1)
        assert "lies outside" in await problem(p, "open_experiment", path="../outside.json")
        assert "lies outside" in await problem(p, "open_experiment", path="leaves.json")
        assert "is a model" in await problem(p, "open_experiment", path="two-targets.model.json")
        assert "no such file" in await problem(p, "open_experiment", path="nothing.json")
        await p.open("open_experiment", path="two-targets.json")
        view = experiment(p)
        assert "another page" in await problem(p, "edit_experiment", data={}, version=view["version"] + 1)
        wrong = view["data"] | {"world": f"arena:{tmp_path / 'outside.json'}"}
        await p.do("edit_experiment", data=wrong, version=view["version"])
        assert "lies outside" in experiment(p)["problems"][0]["what"]
        many = view["data"] | {"trials": 10**6}
        await p.do("edit_experiment", data=many, version=experiment(p)["version"])
        assert "4000000 trials" in experiment(p)["problems"][0]["what"]
        assert "4000000 trials" in await problem(p, "run_experiment")
        (folder / "other.json").write_text("{}")
        assert (await p.ask("save_experiment", path="other.json"))["ask"] == "replace"

    with studio(folder) as address:
        play(address, scene)


class Desk:
    """A studio without sockets: requests are handled in the loop of the test."""

    def __init__(self, root: Path) -> None:
        self.hub = hub.Hub(root, False, None)
        self.page = self.hub.new_page()

    async def do(self, type: str, **fields: Any) -> None:
        message = msgspec.convert({"type": type, **fields}, union(MESSAGES))
        await message.answers(self.hub, self.page)

    async def edit(self, **changes: Any) -> None:
        """Change the plain data of the open experiment."""
        experiment = self.hub.experiment
        settings = {**(experiment.data or {}), **changes}
        await self.do("edit_experiment", data=settings, version=experiment.version)


@contextlib.asynccontextmanager
async def desk(root: Path) -> AsyncIterator[Desk]:
    one = Desk(root)
    try:
        yield one
    finally:
        await one.hub.close()


class Slow(PageConnection):
    """A connection without a socket; `while_sending` runs while it sends a message or frames."""

    def __init__(self, one: Desk, at: str, while_sending: Callable[[], Awaitable[None]]) -> None:
        super().__init__(cast("Any", None), one.hub)
        self.sent: list[Any] = []
        self.at, self.while_sending = at, while_sending

    async def _between(self, at: str) -> None:
        if at == self.at:
            self.at = "never again"
            await self.while_sending()

    async def _text(self, message: Any) -> None:
        self.sent.append(message)
        await self._between("experiment" if isinstance(message, ExperimentView) else "")

    async def _send_frames(self, *args: object) -> None:
        await self._between("frames")

    async def exchange(self) -> None:
        """Send what is new."""
        await self._say()

    def answer(self, answer: Answer) -> None:
        """Queue an answer, as after a request."""
        self._answers.append(answer)


@pytest.mark.parametrize("at", ["experiment", "frames"])
def test_the_answer_to_an_edit_follows_the_edited_experiment(folder: Path, at: str) -> None:
    """Also if the edit is made while older messages are sent: a page makes the next edit of what it has."""

    async def scene() -> None:
        async with desk(folder) as d:
            await d.do("new")
            await d.do("new_experiment")

            async def edit() -> None:
                await d.edit(trials=7)
                connection.answer(Answer(request=5))

            connection = Slow(d, at, edit)
            for _ in range(2):
                await connection.exchange()
            kinds = [m for m in connection.sent if isinstance(m, (Answer, ExperimentView))]
            assert [type(m).__name__ for m in kinds] == ["ExperimentView", "ExperimentView", "Answer"]
            assert kinds[1].data["trials"] == 7

    asyncio.run(scene())


def test_one_run_starts_if_two_pages_ask_for_it_at_once(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    few().save(folder / "two-targets.json")
    started: list[ExperimentRun] = []

    def start(run: ExperimentRun, place: RunPlace) -> None:
        run.state = "running"
        started.append(run)

    monkeypatch.setattr(ExperimentRun, "start", start)

    async def scene() -> None:
        async with desk(folder) as d:
            await d.do("open_experiment", path="two-targets.json")
            asked = [d.do("run_experiment") for _ in range(2)]
            first, second = await asyncio.gather(*asked, return_exceptions=True)
            assert first is None and "runs already" in str(second)
            assert started == [d.hub.experiment.run]

    asyncio.run(scene())


def test_an_experiment_closes_while_one_of_its_trials_is_repeated(folder: Path) -> None:
    few(1).run(folder / "results")

    async def scene() -> None:
        async with desk(folder) as d:
            await d.do("open_experiment", path="results/experiment.json")
            run = d.hub.experiment.run
            assert run is not None
            repeated = asyncio.create_task(d.do("repeat_trial", trial=2))
            while not run._worker.started:
                await asyncio.sleep(0.01)
            await d.do("close_experiment")
            assert d.hub.experiment.data is None and not run._worker.started
            with pytest.raises(DeodarError, match="was closed"):
                await repeated
            assert d.hub.project.record.reader is None

    asyncio.run(scene())


@pytest.mark.parametrize(
    ("wrong", "found"),
    [
        ({"dt": 0}, "expected a number above 0"),
        ({"world": "arena:" + "a" * 5000}, "cannot be read: File name too long"),
    ],
    ids=["step", "world"],
)
def test_an_experiment_that_cannot_be_opened_states_its_problem(
    folder: Path, wrong: dict[str, Any], found: str
) -> None:
    few().save(folder / "two-targets.json")

    async def scene() -> None:
        async with desk(folder) as d:
            await d.do("open_experiment", path="two-targets.json")
            await d.edit(**wrong)
            [problem] = d.hub.experiment.problems
            assert found in problem.what

    asyncio.run(scene())


def test_the_studio_checks_an_experiment_after_a_check_that_failed(
    folder: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(hub, "FOLLOW_SECONDS", 0.001)
    checks: list[OpenExperiment] = []

    async def check(experiment: OpenExperiment) -> None:
        checks.append(experiment)
        if len(checks) < 3:
            raise ZeroDivisionError("of an experiment")

    monkeypatch.setattr(OpenExperiment, "check", check)

    async def scene() -> None:
        async with desk(folder), asyncio.timeout(WAIT):
            while len(checks) < 4:
                await asyncio.sleep(0.001)

    asyncio.run(scene())
    reports = [record for record in caplog.records if "of an experiment" in (record.exc_text or "")]
    assert len(reports) == 1


def test_the_document_with_its_edits_is_open_again_after_the_record_of_a_trial(
    folder: Path, monkeypatch: pytest.MonkeyPatch, own_state: Path
) -> None:
    monkeypatch.setattr(hub, "STORE_SECONDS", 1e6)  # only the opening of the record stores edits
    few(1).run(folder / "results")
    few(1).save(folder / "two-targets.json")
    ready, computed = threading.Event(), ExperimentRun.repeat

    def repeat(run: ExperimentRun, trial: int) -> Path:
        path = computed(run, trial)
        assert ready.wait(WAIT)
        return path

    monkeypatch.setattr(ExperimentRun, "repeat", repeat)

    async def scene() -> None:
        async with desk(folder) as d:
            project, experiment = d.hub.project, d.hub.experiment
            await d.do("open_experiment", path="results/experiment.json")
            await d.do("open_file", path="two-targets.model.json")
            u = project.history.document().entries[0].id
            await d.do("set", element=u, parameter="tau", value=40.0)
            repeated = asyncio.create_task(d.do("repeat_trial", trial=1))
            await d.do("set", element=u, parameter="tau", value=50.0)
            ready.set()
            await repeated
            assert experiment.repeated == 1 and project.record.reader is not None
            [stored] = (own_state / "unsaved").glob("*.json")
            assert dd.load(stored).get("u.tau") == 50.0
            with pytest.raises(ConfirmationRequired):
                await d.do("open_file", path="two-targets.model.json")
            await d.do("leave_trial")
            assert project.record.reader is None and project.history.unsaved and stored.is_file()
            assert project.file.path == folder / "two-targets.model.json"
            assert project.history.model is not None and project.history.model.get("u.tau") == 50.0
            await d.do("undo")
            await d.do("undo")
            assert project.history.model.get("u.tau") == 20.0 and not project.history.unsaved

    asyncio.run(scene())


def test_saving_an_experiment_asks_before_it_replaces_a_file_of_others(folder: Path) -> None:
    few().save(folder / "two-targets.json")
    other = (folder / "two-targets.model.json").read_text(encoding="utf-8")
    (folder / "exp.model.json").write_text("{}", encoding="utf-8")

    async def scene() -> None:
        async with desk(folder) as d:
            await d.do("open_text", name="other.json", text=other)
            await d.do("new_experiment")
            with pytest.raises(ConfirmationRequired) as asked:
                await d.do("save_experiment", path="exp.json")
            assert (asked.value.question, asked.value.file) == ("replace", "exp.model.json")
            assert (folder / "exp.model.json").read_text(encoding="utf-8") == "{}"
            await d.do("save_experiment", path="exp.json", replace=True)
            await d.edit(trials=5)
            await d.do("save_experiment")  # both files are its own now
            assert dd.Experiment.load(folder / "exp.json").trials == 5
            (folder / "exp.json").write_text("{}", encoding="utf-8")
            with pytest.raises(ConfirmationRequired) as asked:
                await d.do("save_experiment")
            assert asked.value.file == "exp.json"

    asyncio.run(scene())


def test_an_experiment_keeps_its_model_while_another_document_is_open(folder: Path) -> None:
    few().save(folder / "a.json")
    few().save(folder / "b.json")

    async def scene() -> None:
        async with desk(folder) as d:
            await d.do("open_experiment", path="a.json")
            await d.do("open_file", path="b.model.json")
            await d.edit(trials=5)
            with pytest.raises(DeodarError, match="belongs to a"):
                await d.do("save_experiment")
            with pytest.raises(DeodarError, match="is the file of the model"):
                await d.do("save_experiment", path="b.model.json", replace=True)
            await d.do("save_experiment", path="c.json")
            await d.do("open_file", path="a.model.json")
            await d.do("open_file", path="b.model.json")
            await d.do("save_experiment")

    asyncio.run(scene())
    models = {name: json.loads((folder / name).read_text())["model"] for name in ("a.json", "c.json")}
    assert models == {"a.json": "a.model.json", "c.json": "b.model.json"}


@pytest.mark.parametrize(
    "leaves",
    [
        {"type": "new_experiment"},
        {"type": "close_experiment"},
        {"type": "open_experiment", "path": "two-targets.json"},
        {"type": "open_file", "path": "two-targets.json"},
    ],
    ids=lambda leaves: leaves["type"],
)
def test_unsaved_edits_of_an_experiment_are_asked_about(folder: Path, leaves: dict[str, str]) -> None:
    few().save(folder / "two-targets.json")

    async def scene() -> None:
        async with desk(folder) as d:
            await d.do("open_experiment", path="two-targets.json")
            await d.do("new_experiment")
            await d.do("new_experiment")  # no edit would be lost
            await d.edit(trials=7)
            with pytest.raises(ConfirmationRequired, match="unsaved_experiment"):
                await d.do(**leaves)
            assert d.hub.experiment.view().data["trials"] == 7
            await d.do(**leaves, discard_experiment=True)
            assert (d.hub.experiment.data or {}).get("trials") != 7

    asyncio.run(scene())


def test_edits_of_an_experiment_are_undone_and_redone(folder: Path) -> None:
    async def scene() -> None:
        async with desk(folder) as d:
            await d.do("new")
            await d.do("new_experiment")
            experiment = d.hub.experiment
            texts = [json.dumps(experiment.data)]
            for changes in ({"trials": 7}, {"limit": 50.0}, {"trials": 9, "name": "other"}):
                await d.edit(**changes)
                texts.append(json.dumps(experiment.data))
            assert (experiment.view().undo, experiment.view().redo) == (3, 0)
            for text in texts[-2::-1]:
                await d.do("undo_experiment")
                assert json.dumps(experiment.data) == text
            assert not experiment.unsaved
            version = experiment.version
            await d.do("undo_experiment")  # there is none
            assert experiment.version == version
            for text in texts[1:]:
                await d.do("redo_experiment")
                assert json.dumps(experiment.data) == text
            await d.do("undo_experiment")
            await d.edit(trials=11)
            assert (experiment.view().undo, experiment.view().redo) == (3, 0)
            await d.do("save_experiment", path="a.json")
            assert experiment.view().undo == 3
            await d.do("new_experiment")
            assert experiment.view().undo == 0

    asyncio.run(scene())


def test_an_edited_experiment_is_recovered_after_a_kill(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    few().save(folder / "a.json")

    async def edited() -> None:
        one = Desk(folder)  # it is not closed, as after a kill
        await one.do("open_experiment", path="a.json")
        await one.hub.experiment.store_edits()
        assert not one.hub.experiment.edits
        await one.edit(trials=7)
        await one.hub.experiment.store_edits()
        assert one.hub.experiment.edits and not (await one.hub.gallery()).recoveries

    asyncio.run(edited())
    monkeypatch.setattr(state_store, "_lives", lambda process: False)

    async def recovered() -> None:
        async with desk(folder) as d:
            [found] = (await d.hub.gallery()).recoveries
            assert (found.experiment, found.title) == ("two targets", "two targets")
            await d.do("new")
            await d.do("new_experiment")
            await d.edit(trials=3)
            with pytest.raises(ConfirmationRequired, match="unsaved_experiment"):
                await d.do("recover", name=found.name)
            await d.do("recover", name=found.name, discard_experiment=True)
            view = d.hub.experiment.view()
            assert (view.data or {})["trials"] == 7 and view.unsaved and view.problems == []
            assert view.file == "a.json" and view.trials == 28
            assert not d.hub.project.history.unsaved, "its model has the content of its file"
            assert not (await d.hub.gallery()).recoveries
            with pytest.raises(ConfirmationRequired, match="replace"):
                await d.do("save_experiment")  # another program may have changed it meanwhile
            await d.do("save_experiment", replace=True)
            assert not (await d.hub.gallery()).recoveries and not d.hub.store.stored_edits()

    asyncio.run(recovered())
    assert json.loads((folder / "a.json").read_text())["trials"] == 7
