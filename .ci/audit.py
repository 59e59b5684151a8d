"""Look up the libraries of the studio's page and of Python in the lists of known vulnerabilities.

python .ci/audit.py

Status 1 if a vulnerability is known. Where the registry in use answers no such question, it says that nothing
was audited, with status 0. The Python packages are those of requirements.lock; they need the package
pip-audit (`pip install pip-audit`).
"""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
COMMANDS = {
    "npm": [sys.executable, "studio/build.py", "npm", "audit", "--json", "--package-lock-only"],
    "pip": [
        sys.executable,
        "-m",
        "pip_audit",
        "-r",
        "requirements.lock",
        "--require-hashes",
        "--disable-pip",
        "--progress-spinner",
        "off",
        "-f",
        "json",
    ],
}


@dataclass(frozen=True)
class Verdict:
    """What an audit found.

    Attributes:
        audited: number of libraries that were looked up; None: all of the lock file, however many.
        missed: number of libraries that the registry does not know.
        found: a line for each library with a known vulnerability.
        why: why nothing was audited, or "".
    """

    audited: int | None = None
    missed: int = 0
    found: tuple[str, ...] = ()
    why: str = ""

    def __str__(self) -> str:
        if self.why or self.audited == 0:
            return (
                "nothing was audited:"
                f" {self.why or f'the registry knows none of the {self.missed} libraries'}"
            )
        count = "all libraries were" if self.audited is None else f"{self.audited} libraries were"
        rest = f"; {self.missed} could not be" if self.missed else ""
        lines = [
            f"{count} audited{rest}, {len(self.found)} with a known vulnerability",
            *(f"  {line}" for line in self.found),
        ]
        return "\n".join(lines)


def npm(answer: str) -> Verdict:
    """Read what `npm audit --json` printed."""
    data = _json(answer)
    if data is None:
        return Verdict(why=_short(answer))
    if "vulnerabilities" not in data:
        error = data.get("error")
        said = error.get("summary") if isinstance(error, dict) else ""
        return Verdict(why=_short(data.get("message") or said or answer))
    listed = data["vulnerabilities"]
    return Verdict(
        found=tuple(
            f"{name}: {about.get('severity', 'unknown')}, versions {about.get('range', '?')}"
            for name, about in listed.items()
        )
    )


def pip(answer: str) -> Verdict:
    """Read what `pip-audit -f json` printed; it says that nothing is known also where it could ask
    nothing.
    """
    data = _json(answer)
    if data is None or "dependencies" not in data:
        return Verdict(why=_short(answer))
    looked = [d for d in data["dependencies"] if "skip_reason" not in d]
    found = tuple(
        f"{d['name']} {d['version']}: {', '.join(v['id'] for v in d['vulns'])}"
        for d in looked
        if d.get("vulns")
    )
    return Verdict(len(looked), len(data["dependencies"]) - len(looked), found)


def _json(answer: str) -> dict[str, Any] | None:
    """The JSON object in an answer, which warnings may surround."""
    start = answer.find("{")
    if start < 0:
        return None
    try:
        found, _ = json.JSONDecoder().raw_decode(answer[start:])
    except ValueError:
        return None
    return found if isinstance(found, dict) else None


def _short(text: str) -> str:
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    return lines[-1][:200] if lines else "it answered nothing"


def main() -> int:
    """Run both audits; status 1 if either found something."""
    status = 0
    for name, read in (("npm", npm), ("pip", pip)):
        done = subprocess.run(COMMANDS[name], cwd=ROOT, capture_output=True, text=True)
        verdict = read(done.stdout if "{" in done.stdout else done.stdout + done.stderr)
        print(f"{name}: {verdict}")
        status |= bool(verdict.found)
    return status


if __name__ == "__main__":
    sys.exit(main())
