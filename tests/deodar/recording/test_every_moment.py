"""A run that is killed at any moment of its writing leaves a record that is the beginning of a whole one."""

from __future__ import annotations

import os
import shutil
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import deodar as dd
from deodar.model import partial
from deodar.recording import files, growing
from deodar.session import run

STEPS = 3000


def model() -> dd.Model:
    model = dd.Model("noisy")
    axes = [dd.Axis("x", 0, 20, samples=21)]
    model.add(dd.Field("u", axes, kernel=[dd.Gaussian(6, 2)], noise=0.5))
    return model


def test_a_kill_at_any_moment_leaves_a_beginning_of_the_record(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Before each call that makes something durable the folder is copied: a kill would leave that."""
    out, killed, one_at_a_time = tmp_path / "run", list[Path](), threading.RLock()

    def copied_before(call: Callable[..., Any]) -> Callable[..., Any]:
        def copy_and_call(*args: Any, **options: Any) -> Any:
            with one_at_a_time:
                if out.exists():
                    killed.append(Path(shutil.copytree(out, tmp_path / f"killed-{len(killed)}")))
                return call(*args, **options)

        return copy_and_call

    with monkeypatch.context() as patch:
        for name in ("fsync", "replace", "rename"):
            patch.setattr(os, name, copied_before(getattr(os, name)))
        patch.setattr(growing, "FLUSH_SECONDS", 0.0)
        patch.setattr(run, "CHUNK_SECONDS", 0.002)
        dd.simulate(model(), STEPS, seed=3, record="u", out=dd.Output(out, snapshots=200))
    whole = files.load_record(out)["u.activation"]
    begun = [place for place in killed if (place / "record.zarr" / "zarr.json").exists()]
    parts = [files.load_record(place)["u.activation"] for place in begun]
    sizes = [part.sizes["time"] for part in parts]
    assert all(part.equals(whole.isel(time=slice(size))) for part, size in zip(parts, sizes, strict=True))
    assert len(begun) > 30 and sizes == sorted(sizes)
    middle = next(place for place, size in zip(begun, sizes, strict=True) if 5 < size < len(whole))
    killed_names = {path.name for place in begun for path in place.rglob(".*.partial*")}
    assert any(partial.FORM.fullmatch(name) for name in killed_names)
    dd.resume(middle)
    assert not list(middle.rglob(".*.partial*")), "what the kill left is taken over"
    assert files.load_record(middle)["u.activation"].equals(whole)
