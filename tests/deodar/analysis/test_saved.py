"""Files of analyses."""

from __future__ import annotations

from pathlib import Path

import pytest

import deodar as dd
from deodar import codec
from deodar.analysis.continuation.branch import SteadyBranch
from deodar.analysis.continuation.locus import Locus
from deodar.analysis.maps.map_result import RegimeMap
from deodar.analysis.saved import SavedAnalysis
from deodar.errors import RecordError
from deodar.recording.provenance import KEY
from deodar.recording.record import about
from tests.deodar.recording.models import record


@pytest.mark.parametrize("kind", [SteadyBranch, Locus, RegimeMap])
def test_a_record_that_is_called_an_analysis_is_damage(tmp_path: Path, kind: type[SavedAnalysis]) -> None:
    run = record()
    run.attrs[KEY] = codec.line({**about(run), kind.KIND: {"at": 3}})
    path = dd.save_record(run, tmp_path / "run.nc")
    with pytest.raises(RecordError, match=f"run.nc: is damaged: {kind.PHRASE} cannot be read"):
        kind.load(path)
