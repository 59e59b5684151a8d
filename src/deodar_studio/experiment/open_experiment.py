"""The open experiment: its plain data, which pages edit, its file, and its run."""

from __future__ import annotations

import asyncio
import dataclasses as dc
import hashlib
import os
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from deodar import codec, regular_file
from deodar.cluster import Cluster
from deodar.codec import JsonObject
from deodar.errors import DeodarError, DocumentError, Problem, problems_of
from deodar.experiments.design import EXAMPLE, VERSION
from deodar.experiments.experiment import Experiment
from deodar.experiments.following import FOLLOW_SECONDS
from deodar.experiments.results import EXPERIMENT, ROWS
from deodar.experiments.setup import Setup
from deodar.model.document import Document
from deodar.model.document_files import MOST_BYTES
from deodar.model.edit import UndoHistory
from deodar.model.model import Model
from deodar.recording import places
from deodar_studio.catalogue import gallery
from deodar_studio.experiment.experiment_run import ExperimentRun
from deodar_studio.experiment.run_place import SLURM, RunPlace
from deodar_studio.files import content
from deodar_studio.files.file_thread import in_file_thread, try_in_file_thread
from deodar_studio.files.state_store import StateStore, StoredExperiment
from deodar_studio.files.workspace import Workspace
from deodar_studio.messages.message import made_of
from deodar_studio.messages.to_page import ExperimentView, RunView, TrialRows
from deodar_studio.project.confirmation import ConfirmationRequired
from deodar_studio.project.file_state import plain
from deodar_studio.project.open_project import OpenProject
from deodar_studio.views import view

LIMIT, TRIALS = 1000.0, 20
"""Longest duration of a trial, in document time, and number of trials of a new experiment."""

MOST_TRIALS = 100_000
"""Most trials of one run: pages receive every row (a guess)."""

MOST_ROWS = 1000
"""Most rows in one message."""

APART = ("experiment", "model", "packages")
"""Keys of a file that pages do not edit."""


class OpenExperiment:
    """The open experiment, if any; its model is the open document.

    Methods that change it must be called through the queue of the project, except `repeat`, `stop` and
    `check`.

    While the record of one of its trials is open, its model is the document that the project set aside.

    Args:
        project: the open document and its queue.
        workspace: the files below the root.
        store: where unsaved edits are stored.
        changed: called when pages may have something new to show.
        private: whether pages may name any cluster (see `RunPlace`).

    Attributes:
        version: number of changes that pages must receive.
        file: the file of the experiment.
        problems: what prevents its run.
        trials: number of trials of a run.
        run: the latest run, or the results beside its file.
        number: counter of runs.
        repeated: the trial whose record is open.
        edits: the name under which its unsaved edits are stored; empty: they are not.
    """

    def __init__(
        self,
        project: OpenProject,
        workspace: Workspace,
        store: StateStore,
        changed: Callable[[], None],
        private: bool,
    ) -> None:
        self._project, self._workspace, self._store, self._changed = project, workspace, store, changed
        self._private, self._looked = private, 0.0
        self.version = 0
        self.file: Path | None = None
        self.problems: Sequence[Problem] = ()
        self.trials = 0
        self.run: ExperimentRun | None = None
        self.number = 0
        self.repeated: int | None = None
        self.edits = ""
        self._saved: JsonObject | None = None
        self._stored: tuple[JsonObject, Document] | None = None
        self._history: UndoHistory[JsonObject] | None = None
        self._model: tuple[Model | None, Path | None] = (None, None)  # of the file, and its own file
        self._digests: dict[Path, str] = {}
        self._shown = Path()
        self._repeats = 0
        self._checked: tuple[int, Document | None] = (0, None)

    # ------------------------------------------------------------------------------------------------ looking

    @property
    def data(self) -> JsonObject | None:
        """The plain data without its version and model; None: no experiment is open."""
        return None if self._history is None else self._history.document

    @property
    def unsaved(self) -> bool:
        """Whether the experiment was edited since it was made, opened or saved."""
        return self.data is not None and self.data != self._saved

    def view(self) -> ExperimentView:
        """Return the experiment as a message."""
        run, history = self.run, self._history
        shown = None
        if run is not None:
            now = run.standing if run.state in ("running", "followed") else None
            shown = made_of(
                RunView,
                run,
                number=self.number,
                folder=self._workspace.shown(run.folder),
                rows=len(run.rows),
                trials=run.setup.trials,
                problems=view.problems(run.problems),
                cluster="" if run.place.cluster is None else self._named_cluster(run.place.cluster),
                workers=run.staffing.workers,
                pieces=run.staffing.running,
                slowest="" if now is None else now.slowest,
                diverged=[] if now is None else list(now.diverged),
            )
        return made_of(
            ExperimentView,
            self,
            file="" if self.file is None else self._workspace.shown(self.file),
            undo=0 if history is None else history.depth,
            redo=0 if history is None else history.ahead,
            problems=view.problems(self.problems),
            run=shown,
        )

    def _named_cluster(self, cluster: Cluster) -> str:
        """Return the address of a cluster, with a file as pages name it."""
        file = cluster.file
        return cluster.address if file is None else f"{SLURM}{self._workspace.shown(file)}"

    def rows_after(self, number: int, count: int) -> TrialRows | None:
        """Return rows that a page lacks, which has the first `count` rows of a run; None: it has all."""
        run = self.run
        first = count if number == self.number else 0
        rows = [] if run is None else run.rows[first : first + MOST_ROWS]
        return TrialRows(run=self.number, first=first, rows=rows) if rows else None

    def _present(self) -> tuple[Model | None, Path | None]:
        """Return the open document, or the one that was set aside, and its file."""
        aside, project = self._project.record.aside, self._project
        if aside is None:
            return project.history.model, project.file.path
        return aside.model, aside.file.path

    def _document(self) -> Document:
        """Return the model of the experiment, without positions of panels."""
        record, model = self._project.record, self._project.history.model
        if record.aside is not None:
            return plain(record.aside.model.document)
        if model is None or record.reader is not None:
            raise DocumentError("no document is open", fix="Open the model of the experiment first")
        return plain(model.document)

    def _experiment(self, model: object) -> Experiment:
        """Return the experiment of the plain data."""
        data = self._require().document
        found = Experiment.from_data({**data, "experiment": VERSION, "model": "the open document"})
        return dc.replace(found, model=model)

    def _setup(self) -> Setup:
        trust = self._project.trust
        found = self._experiment(Model(document=self._document(), trusted=trust))
        if found.count > MOST_TRIALS:
            fix = f"The command deodar experiment runs more than {MOST_TRIALS} trials"
            raise DocumentError(f"has {found.count} trials", where="trials", fix=fix)
        return dc.replace(found, world=self._world(str(found.world))).setup(trust)

    def _world(self, named: str) -> str:
        """Return the name of a world with the path of its file, which is below the root.

        Raises:
            DocumentError: the file lies outside the root.
        """
        kind, sign, argument = named.partition(":")
        folder = self._workspace.root if self.file is None else self.file.parent
        place = self._workspace.inside(str(folder / argument))
        if argument and place.exists():
            return f"{kind}{sign}{place}"
        if argument and Path(argument).exists():
            raise DocumentError("lies outside the folder of the studio", where=f"world: {argument}")
        return named

    async def check(self) -> None:
        """Find the problems of the experiment, if it or its model changed since the last check."""
        record = self._project.record.reader
        if self.repeated is not None and (record is None or record.path != self._shown):
            self.repeated = None  # the record of the trial was closed
        try:
            now = self.version, None if self.data is None else self._document()
        except DeodarError:
            now = self.version, None
        if now == self._checked:
            return
        self._checked = now

        def find() -> tuple[Sequence[Problem], int]:
            try:
                return (), self._setup().trials
            except OSError as error:
                return [Problem("world", f"cannot be read: {error.strerror}")], 0
            except Exception as error:  # worlds and functions that the experiment and its model name
                return problems_of(error), 0

        found = await asyncio.to_thread(find) if self.data is not None else ((), 0)
        if now == self._checked:
            self.problems, self.trials = found
            self._changed()

    # ------------------------------------------------------------------------------------ opening and closing

    async def new(self, discard: bool) -> None:
        """Open a new experiment with the open document.

        Raises:
            ConfirmationRequired: without `discard`, if the open experiment has unsaved edits.
        """
        self._require_end(discard)
        data: JsonObject = {"name": self._document().name, "limit": LIMIT, "trials": TRIALS}
        await self._take(data, None, data)

    async def open(self, place: Path, discard: bool, discard_experiment: bool) -> None:
        """Open an experiment and its model; the rows beside its file are those of its run.

        Raises:
            ConfirmationRequired: without `discard`, if the document has unsaved edits, or, without
                `discard_experiment`, the open experiment.
        """
        self._require_end(discard_experiment)

        def read() -> tuple[Experiment, str]:
            with self._workspace.folder(place) as folder:
                content = folder.read(place.name, MOST_BYTES)
            found = Experiment.from_data(
                codec.read(content), None, lambda name: Model(document=self._named(place, name)[0]())
            )
            return found, hashlib.sha256(content).hexdigest()

        try:
            found, digest = await in_file_thread(read, str(place))
        except FileNotFoundError:
            raise DocumentError("there is no such file", where=self._workspace.shown(place)) from None
        document, file = self._named(place, str(found.model))
        await self._project.open_model(document, file, str(found.model), discard)
        if self._project.history.model is None:
            return
        data: Any = codec.parse(codec.line(found.to_data()))
        await self._take({key: value for key, value in data.items() if key not in APART}, place, None)
        self._saved, self._digests = self.data, {place: digest}
        if place.name == EXPERIMENT and (place.parent / ROWS).is_file():
            run = ExperimentRun(await asyncio.to_thread(self._setup), place.parent, self._changed)
            await in_file_thread(run.open, str(place))
            run.take()
            self.run = run
            self.number += 1
            if run.state != "followed":
                run.prepare()

    async def follow(self) -> None:
        """Show the rows that another process has added to the folder of opened results."""
        run, now = self.run, time.monotonic()
        if run is None or not run.follows or now - self._looked < FOLLOW_SECONDS:
            return
        self._looked = now
        await try_in_file_thread(run.look)
        if run is self.run and run.take():
            self._changed()
            if run.state == "complete":
                run.prepare()

    def _named(self, place: Path, name: str) -> tuple[Callable[[], Document], Path | None]:
        """Return a function that reads the model of an experiment, and the file of this model."""
        if name.startswith(EXAMPLE):
            example = gallery.example_file(name.removeprefix(EXAMPLE))
            return lambda: content.load(self._workspace, example), None
        beside = self._workspace.inside(str(place.parent / name))
        return lambda: content.load(self._workspace, beside), beside

    async def _take(self, data: JsonObject, file: Path | None, saved: JsonObject | None) -> None:
        await self._end_run()
        await self._forget()
        self._history, self.file, self._saved = UndoHistory(data), file, saved
        self.run, self.repeated = None, None
        self._model, self._digests = self._present(), {}
        self._edited()

    async def close(self, discard: bool) -> None:
        """Close the experiment.

        Raises:
            ConfirmationRequired: without `discard`, if it has unsaved edits.
        """
        self._require_end(discard)
        await self._end_run()
        await self._forget()
        self._history, self.file, self.run, self.repeated = None, None, None, None
        self.problems, self.trials = (), 0
        self._edited()

    def end(self) -> None:
        """End all processes, when the studio ends."""
        if self.run is not None:
            self.run.close()

    def _require_end(self, discard: bool) -> None:
        if self.run is not None and self.run.state == "running":
            raise DocumentError("its experiment is running", fix="Stop the experiment first")
        if self.unsaved and not discard:
            raise ConfirmationRequired("unsaved_experiment")

    async def _end_run(self) -> None:
        """End the processes of the run, which are those of a repetition, if there is one."""
        if self.run is not None:
            await asyncio.to_thread(self.run.close)

    # ------------------------------------------------------------------------------------- editing and saving

    def edit(self, data: JsonObject, version: int) -> None:
        """Replace the plain data; `version` is the version that the page has changed."""
        if self._history is None or version != self.version:
            raise DocumentError("the experiment was changed on another page", fix="Repeat the change")
        self._history.commit(data)
        self._edited()

    def undo(self) -> None:
        """Undo the last edit, if there is one."""
        if self._require().undo():
            self._edited()

    def redo(self) -> None:
        """Redo the edit that was undone last, if there is one."""
        if self._require().redo():
            self._edited()

    def _require(self) -> UndoHistory[JsonObject]:
        if self._history is None:
            raise DocumentError("no experiment is open")
        return self._history

    def _edited(self) -> None:
        self.version += 1
        self._changed()

    async def store_edits(self) -> None:
        """Store unsaved edits with the model, if they are new."""
        if self.data is None or not self.unsaved:
            return
        try:
            doc, (_, own) = self._document(), self._present()
        except DeodarError:
            return  # its model is not open
        stored = self._stored
        if stored is not None and stored[0] is self.data and stored[1] == doc:
            return
        self.edits = self.edits or self._store.new_name()
        note = StoredExperiment(self.data, "" if self.file is None else str(self.file))
        name, file = self.edits, "" if own is None else str(own)
        await try_in_file_thread(lambda: self._store.store_edits(name, doc, file, note))
        self._stored = self.data, doc

    async def recover(self, name: str, discard: bool, discard_experiment: bool) -> None:
        """Open stored unsaved edits of an experiment, with its model.

        Raises:
            ConfirmationRequired: without `discard`, if the document has unsaved edits, or, without
                `discard_experiment`, the open experiment.
        """
        self._require_end(discard_experiment)
        found = await in_file_thread(lambda: self._store.experiment(name), name)
        if found is None:
            raise DocumentError("no experiment is stored under this name")
        await self._project.recover_model(name, discard)
        if self._project.history.model is None:
            return
        file = Path(found.file) if found.file else None
        if file is not None and not self._workspace.holds(file):
            file = None
        await self._take(found.data, file, None)
        self.edits = name

    async def _forget(self) -> None:
        """Delete stored edits."""
        name, self.edits, self._stored = self.edits, "", None
        if name:
            await try_in_file_thread(lambda: self._store.forget(name))

    async def save(self, path: str, replace: bool) -> Path:
        """Write the experiment to a path, or to its own file; a model without a file is written beside it.

        Raises:
            ConfirmationRequired: without `replace`, if one of the files that are written exists, and was not
                read or written by this experiment last.
            DocumentError: the experiment has problems that a file cannot have, or another document than its
                model is open.
        """
        place = self._workspace.target(path) if path else self.file
        if place is None:
            raise DocumentError("the experiment has no file yet", fix="Save it under a name")
        present, own = self._present()
        if place == self.file:
            self._require_own(place)
            if self.run is not None and self.run.state == "followed":
                raise DocumentError("another process runs it", where=path, fix="Save it under another name")
        if place == own:
            raise DocumentError("is the file of the model", where=path, fix="Save it under another name")
        model = Model(document=self._document()) if own is None else os.path.relpath(own, place.parent)
        experiment = self._experiment(model)

        def make() -> dict[Path, bytes]:
            with tempfile.TemporaryDirectory(prefix="deodar-") as private:
                experiment.save(Path(private) / place.name)
                return {
                    place.with_name(file.name): regular_file.read_bytes(file)
                    for file in Path(private).iterdir()
                }

        def write() -> None:
            with self._workspace.folder(place) as to:
                # the experiment last, because it refers to the model
                for file in sorted(made, key=lambda file: file == place):
                    to.write(file.name, made[file])

        made = await in_file_thread(make, str(place))
        digests = {file: hashlib.sha256(content).hexdigest() for file, content in made.items()}
        for file in made if not replace else ():
            now = await in_file_thread(lambda file=file: self._workspace.digest(file), str(file))
            if now not in ("", self._digests.get(file), digests[file]):
                raise ConfirmationRequired("replace", self._workspace.shown(file))
        await in_file_thread(write, str(place))
        self.file, self._saved, self._digests = place, self.data, digests
        await self._forget()
        self._model = present, own
        self._changed()
        return place

    def _require_own(self, place: Path) -> None:
        """Raise DocumentError if the open document is another one than the model that the file names."""
        (model, file), (present, own) = self._model, self._present()
        if present is not model and (own is None or own != file):
            name = "a model without a file" if file is None else self._workspace.shown(file)
            raise DocumentError(
                f"belongs to {name}, and another document is open",
                where=self._workspace.shown(place),
                fix="Open its model again, or save the experiment under another name",
            )

    # --------------------------------------------------------------------------------------------- the trials

    async def start(self, workers: int, address: str, at: Callable[[str], Cluster]) -> None:
        """Run the experiment where a page asks for it (`RunPlace.of`); a run of the same experiment that was
        stopped continues.

        Raises:
            DocumentError: it runs already, also in another process, or may not run there.
            ParameterError: the address of the cluster is wrong.
            WorkerError: it leads beyond this machine, without encryption.
        """
        if self.run is not None and self.run.state == "running":
            raise DocumentError("the experiment runs already")
        place = RunPlace.of(workers, address, at, self._workspace, self._private)
        setup = await asyncio.to_thread(self._setup)
        before = self.run
        if before is not None and before.state == "followed" and _same(before.setup, setup):
            raise DocumentError("another process runs the experiment", fix="Wait until it ends, or stop it")
        if before is None or before.state == "complete" or not _same(before.setup, setup):
            await self._end_run()
            folder = places.free(self._workspace.root, setup.experiment.name)
            self.run = ExperimentRun(setup, folder, self._changed)
            self.number += 1
        assert self.run is not None
        self.run.start(place)
        self._changed()

    def stop(self) -> None:
        """Stop the run; rows that exist are kept."""
        if self.run is not None and self.run.state == "running":
            self.run.stop()
            self._changed()

    async def repeat(self, trial: int) -> None:
        """Run a trial again and open its record; documents can be edited until it is ready.

        Raises:
            DocumentError: there is no run, or another trial or experiment was opened meanwhile.
        """
        run = self.run
        if run is None:
            raise DocumentError("the experiment has no rows")
        self._repeats += 1
        latest = self._repeats
        path = await asyncio.to_thread(run.repeat, trial)

        async def show() -> None:
            if run is not self.run:
                raise DocumentError(f"trial {trial} is not opened: its experiment was closed")
            if latest != self._repeats:
                raise DocumentError(f"trial {trial} is not opened: another trial was opened meanwhile")
            await self._project.open_trial(path)
            record = self._project.record.reader
            if record is not None:
                self.repeated, self._shown = trial, record.path
            self._changed()

        await self._project.queue.run(show)

    async def leave_trial(self) -> None:
        """Open the model of the experiment again, after the record of a trial."""
        self.repeated = None
        await self._project.reopen()
        self._changed()


def _same(a: Setup, b: Setup) -> bool:
    return a.model.document == b.model.document and a.experiment.to_data() == b.experiment.to_data()
