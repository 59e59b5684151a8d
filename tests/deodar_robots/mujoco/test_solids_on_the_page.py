"""A world in three dimensions, over a real socket: its solids, their poses, and pushes by the user."""

from __future__ import annotations

import asyncio
import base64
from pathlib import Path

import numpy as np

import deodar as dd
from deodar.elements.world_ports import Sensor
from deodar.numerics.axes import Axis
from deodar.worlds._scene import POSE
from deodar_robots.mujoco.mujoco import MuJoCo
from tests.deodar_studio.page import Page, page, play, studio


def poses(p: Page) -> np.ndarray:
    return np.frombuffer(base64.b64decode(p.said["bodies"]["poses"]), np.float32).reshape(-1, POSE)


def test_solids_are_sent_once_and_a_push_ends_with_the_page(tmp_path: Path):
    model = dd.Model("watching", dt=10)
    model.add(Sensor("joints", [Axis("joint", 0, 6, 7)], "joint_angles"))
    file = tmp_path / "watching.json"
    dd.save(model, file)
    world = MuJoCo("table")
    world.place("block", (0.2, 0.4), (0.06, 0.06), (0, 0.8, 0))

    def force() -> float:
        return float(abs(world._copies[0].xfrc_applied).max())

    async def story(p: Page) -> None:
        await p.runs()
        await p.until(lambda: p.said.get("scene", {}).get("scene"))
        assert p.said["scene"]["solid"]
        await p.do("watch_world", on=True)
        await p.until(lambda: "bodies" in p.said)
        assert p.said["bodies"]["poses"] == "" and "solids" not in p.said, "it shows the view from above"
        await p.do("watch_world", on=True, solid=True)
        await p.until(lambda: p.said["bodies"]["poses"] != "")
        solids = p.said["solids"]["solids"]
        assert len(solids) == len(poses(p))
        block, arm = (
            next(k for k, s in enumerate(solids) if s[key] == name)
            for key, name in (("thing", "block"), ("body", "link 7"))
        )
        assert not solids[block]["pushable"] and solids[arm]["pushable"]
        np.testing.assert_allclose(poses(p)[block][:2], (0.2, 0.4), atol=1e-3)
        await p.do("move_object", name="block", x=-0.2, y=0.4)
        await p.until(lambda: abs(poses(p)[block][0] + 0.2) < 1e-3)
        before = poses(p)[arm]
        async with page(studio_at) as other:
            await other.do("push_body", body="link 5", force=[60.0, 0.0, 0.0])
            await p.do("step", n=30)
            await p.until(lambda: p.clock["tick"] == 30 and abs(poses(p)[arm] - before).max() > 5e-3)
            assert force() == 60
        for _ in range(600):
            if force() == 0:
                break
            await asyncio.sleep(0.05)
        assert force() == 0, "its page has left"
        assert sum(m["type"] == "solids" for m in p.all) == 1
        refused = await p.ask("push_body", body="no link", force=[1.0, 0.0, 0.0])
        assert "no body 'no link'" in refused["problems"][0]["what"]

    with studio(tmp_path, file, world=world) as studio_at:
        play(studio_at, story)
