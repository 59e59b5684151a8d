"""JSON Schema of the file of a robot, generated from its declaration."""

from __future__ import annotations

from pathlib import Path

from deodar import codec
from deodar_robots.robot.robot_file import robot_schema

SHIPPED = Path(__file__).with_name("robot.schema.json")
"""The generated schema, part of the package; `python tools/generate.py` writes it."""


def text() -> str:
    """Return the schema as the text of its file."""
    return codec.text(robot_schema(), indent=1) + "\n"


if __name__ == "__main__":
    SHIPPED.write_text(text(), encoding="utf-8", newline="\n")
