"""The benchmark of clusters counts lost, double and different rows."""

from __future__ import annotations

import json

from benchmarks import cluster


def test_lost_double_and_different_rows_are_counted(tmp_path):
    right = [json.dumps({"key": f"{k}", "duration": k}) for k in range(4)]
    lines = [json.dumps({"about": {}}), right[0], right[0], right[1].replace("1}", "7}"), right[3], "{broken"]
    (tmp_path / "trials.jsonl").write_text("\n".join(lines))
    assert cluster.compared(tmp_path, right) == (1, 1, 1)
    assert cluster.compared(tmp_path / "none", right) == (4, 0, 0)
