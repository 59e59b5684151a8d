"""Records as bags of ROS 2."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import xarray

NAME, ENDING = "rosbag", ""
HELP = "a bag of ROS 2 with a topic for each variable (extra network)"


def save(data: xarray.Dataset, path: str | Path, force: bool = False) -> Path:
    """Write a record."""
    # start-up time: this brings NumPy
    from deodar_robots.ros_bag import bag_file as rosbag

    return rosbag.save(data, path, force)
