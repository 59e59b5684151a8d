"""The command `deodar plan FILE`."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import TYPE_CHECKING

from deodar.cli import _options, _work_plan
from deodar.cli._answer import CommandAnswer

if TYPE_CHECKING:
    from deodar.codec import JsonObject
    from deodar.compiler.traffic import Traffic
    from deodar.numerics.choice import Shards

HELP = "print how a model is computed, and what several devices would divide and exchange, without running it"
EPILOG = """\
Without --devices: the groups of equal elements, how their kernels are applied, and the calls of a step. With
--devices N: the axis that N devices divide, the bytes that they exchange in a step, and the memory that each
needs; the devices need not be there."""


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command."""
    parser.epilog = EPILOG
    _options.add_document(parser)
    parser.option("--devices", "N", "divide the fields among N devices, or all", _options.several)
    parser.option("--device", "KIND", "with --devices all: cpu or gpu, whose devices are counted")
    parser.flag("--cluster", "plan the trials of an experiment for many workers")
    _options.add_accuracy(parser)
    _options.add_json(parser)


def run(args: argparse.Namespace) -> CommandAnswer:
    """Print the plan of a document."""
    # start-up time: these bring JAX
    from deodar.compiler import device
    from deodar.compiler.build import Build
    from deodar.compiler.division import Distribution
    from deodar.compiler.plan import plan
    from deodar.compiler.shard import planned
    from deodar.experiments.experiment import Experiment
    from deodar.importers.opening import load
    from deodar.session import memory

    if args.cluster:
        for name in ("devices", "device", "precision", "accuracy"):
            if getattr(args, name) is not None:
                args.wrong(f"--{name} is for a model, and --cluster plans an experiment")
        _options.use_cores(None)  # one core, as workers use
        return _work_plan.answer(Experiment.load(args.file, load).setup())
    model = load(args.file)
    model.require()
    precision = args.precision or "float32"
    count = len(device.several("all", args.device)) if args.devices == "all" else args.devices
    if count is not None:
        device.require_count(count)
    # they need not be here
    on = Distribution((device.find(),) * count, "field") if count is not None and count > 1 else None
    program_plan = plan(Build(model.document, precision, args.accuracy or "default", on))
    if program_plan.shards is None:
        described = program_plan.describe()
        return CommandAnswer({"plan": described.splitlines()}, [described])
    traffic = planned(program_plan, 8 if precision == "float64" else 4)
    bytes_each = memory.device_bytes(
        [n for g in program_plan.groups for n in g.nodes], precision, program_plan.shards
    )
    of = program_plan.shards, traffic, bytes_each
    return CommandAnswer(_fields(*of), [_text(*of)])


def _text(shards: Shards, traffic: Sequence[Traffic], bytes_each: int) -> str:
    lines = [
        f"{shards.devices} devices divide the axis {shards.axis}: {shards.samples} samples,"
        f" {shards.samples // shards.devices} on each"
    ]
    lines += [f"  {t.path}: {t.method}, {t.bytes:,} bytes" for t in traffic]
    lines.append(f"traffic: {sum(t.bytes for t in traffic):,} bytes a step")
    lines.append(f"memory: at most about {bytes_each / 2**20:,.1f} MiB on each device")
    return "\n".join(lines)


def _fields(shards: Shards, traffic: Sequence[Traffic], bytes_each: int) -> JsonObject:
    return {
        "axis": shards.axis,
        "samples": shards.samples,
        "devices": shards.devices,
        "elements": [{"path": t.path, "method": t.method, "bytes": t.bytes} for t in traffic],
        "bytes": sum(t.bytes for t in traffic),
        "memory": bytes_each,
    }
