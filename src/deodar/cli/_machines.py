"""Options that share a run among devices, hosts and workers."""

from __future__ import annotations

import argparse
import shlex
from typing import TYPE_CHECKING

from deodar.cli import _options

if TYPE_CHECKING:
    from deodar.cluster import Cluster


def add_cluster(parser: _options.CommandParser, what: str, mixed: bool = False) -> None:
    """Add `--cluster`, `--trust-network`, `--patience` and `--mixed`.

    Args:
        parser: the parser of the command.
        what: what the workers share.
        mixed: whether to add `--mixed`.
    """
    parser.option(
        "--cluster",
        "ADDRESS",
        f"share the {what} among the workers of a scheduler at tcp://HOST:PORT or tls://HOST:PORT, of"
        " local:N processes, or of jobs of SLURM as slurm:FILE states them (extra cluster)",
    )
    parser.flag(
        "--trust-network",
        "allow workers beyond this machine, in a network of your own: messages are not encrypted",
    )
    if mixed:
        parser.flag("--mixed", "allow workers whose processors differ; each row names its own")
    parser.option(
        "--patience",
        "S",
        "seconds without any worker after which the run ends (default 60)",
        _options.positive,
    )


def cluster(args: argparse.Namespace) -> Cluster | None:
    """Return the cluster of `--cluster`; None without it."""
    if args.cluster is None:
        options = cluster_again(args)
        if options:
            args.wrong(f"{options[0].split()[0]} needs --cluster ADDRESS")
        return None
    if args.workers:
        args.wrong("--workers and --cluster exclude each other")
    # start-up time: this brings JAX
    from deodar.cluster import PATIENCE, Cluster

    mixed = getattr(args, "mixed", False)
    return Cluster(args.cluster, args.trust_network, mixed, args.patience or PATIENCE)


def cluster_again(args: argparse.Namespace) -> list[str]:
    """Return the options of a cluster as they are typed."""
    options = [f"--cluster {shlex.quote(args.cluster)}"] if args.cluster else []
    options += ["--trust-network"] if args.trust_network else []
    options += ["--mixed"] if getattr(args, "mixed", False) else []
    return options + ([f"--patience {args.patience:g}"] if args.patience else [])


def add_devices(parser: _options.CommandParser) -> None:
    """Add `--devices`."""
    parser.option(
        "--devices",
        "N",
        "share trials and sweep points, or the fields of a single run, among N devices of the kind of"
        " --device, or all",
        _options.several,
    )


def add_hosts(parser: _options.CommandParser) -> None:
    """Add `--hosts`."""
    parser.option(
        "--hosts",
        "ADDRESS",
        "with --devices: join the other hosts that run the same command: HOST:PORT,COUNT,INDEX with the"
        " address of the first one, or auto under srun and mpirun",
        hosts,
    )


def join_hosts(args: argparse.Namespace) -> None:
    """Join the hosts of `--hosts`."""
    if args.hosts is None:
        return
    if args.devices is None:
        args.wrong("--hosts needs --devices all, or their number on all hosts together")
    # start-up time: this brings JAX
    from deodar.compiler.hosts import join_hosts as join

    join(*args.hosts)


def hosts(text: str) -> tuple[str] | tuple[str, int, int]:
    """Parse `HOST:PORT,COUNT,INDEX`, or `auto`."""
    if text == "auto":
        return (text,)
    address, *numbers = text.split(",")
    if len(numbers) != 2 or not all(n.isdecimal() for n in numbers):
        raise argparse.ArgumentTypeError(
            f"{text!r} is neither auto nor of the form HOST:PORT,COUNT,INDEX such as node1:7007,2,0"
        )
    return address, int(numbers[0]), int(numbers[1])
