"""The audit reports its findings, and reports sources that it could not query."""

from __future__ import annotations

import json
from types import ModuleType, SimpleNamespace

import pytest

from tests.docs.source import ROOT, module

REFUSED = """npm warn audit 405 Method Not Allowed
npm error audit endpoint returned an error
{"message": "405 Method Not Allowed - POST", "statusCode": 405, "error": {"summary": "", "detail": ""}}
npm error A complete log of this run can be found in a file"""
CLEAN = json.dumps(
    {"auditReportVersion": 2, "vulnerabilities": {}, "metadata": {"dependencies": {"total": 40}}}
)
FOUND = json.dumps(
    {"auditReportVersion": 2, "vulnerabilities": {"left-pad": {"severity": "high", "range": "<1.2"}}}
)
PIP_SKIPPED = json.dumps(
    {"dependencies": [{"name": "numpy", "skip_reason": "Dependency not found"}], "fixes": []}
)
PIP_CLEAN = json.dumps({"dependencies": [{"name": "numpy", "version": "2.0", "vulns": []}], "fixes": []})
PIP_FOUND = json.dumps(
    {
        "dependencies": [
            {"name": "numpy", "version": "2.0", "vulns": [{"id": "PYSEC-1"}]},
            {"name": "jax", "skip_reason": "x"},
        ]
    }
)


@pytest.fixture(scope="module")
def audit() -> ModuleType:
    return module(ROOT / ".ci" / "audit.py")


@pytest.mark.parametrize(
    ("tool", "answer", "says", "found"),
    [
        ("npm", REFUSED, "nothing was audited: 405 Method Not Allowed - POST", 0),
        ("npm", "", "nothing was audited: it answered nothing", 0),
        ("npm", CLEAN, "all libraries were audited, 0 with a known vulnerability", 0),
        ("npm", FOUND, "left-pad: high, versions <1.2", 1),
        ("pip", PIP_SKIPPED, "nothing was audited: the registry knows none of the 1 libraries", 0),
        ("pip", PIP_CLEAN, "1 libraries were audited, 0 with a known vulnerability", 0),
        (
            "pip",
            PIP_FOUND,
            "1 libraries were audited; 1 could not be, 1 with a known vulnerability\n  numpy 2.0: PYSEC-1",
            1,
        ),
        ("pip", "ERROR\nNo module named pip_audit", "nothing was audited: No module named pip_audit", 0),
    ],
)
def test_the_answer_of_a_tool_becomes_a_verdict(
    audit: ModuleType, tool: str, answer: str, says: str, found: int
) -> None:
    verdict = getattr(audit, tool)(answer)
    assert says in str(verdict) and len(verdict.found) == found


@pytest.mark.parametrize(
    ("npm", "pip", "status"), [(REFUSED, PIP_SKIPPED, 0), (CLEAN, PIP_FOUND, 1), (FOUND, PIP_CLEAN, 1)]
)
def test_the_exit_status_states_whether_a_vulnerability_is_known(
    audit: ModuleType,
    npm: str,
    pip: str,
    status: int,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    answers = iter([npm, pip])
    monkeypatch.setattr(
        audit.subprocess, "run", lambda *_, **__: SimpleNamespace(stdout=next(answers), stderr="")
    )
    assert audit.main() == status
    assert [
        line.split(":")[0] for line in capsys.readouterr().out.splitlines() if not line.startswith(" ")
    ] == ["npm", "pip"]
