"""The device of programs by its name, and the number of cores of the CPU."""

from __future__ import annotations

import os
from typing import Any, Protocol

import jax
import numpy as np

from deodar.compiler import hosts
from deodar.errors import DeviceError
from deodar.parameters import show

DEFAULT = "cpu"
"""The default device: a step of a small model takes 1 to 20 microseconds on a CPU, less than the launch of
its kernels on a graphics processor.
"""

KINDS = ("cpu", "gpu", "cuda", "rocm", "tpu")
"""Platforms that are asked for; gpu is cuda or rocm, whichever is there."""

CORES = "NPROC"
"""Environment variable with the number of threads that XLA may use on a CPU; default: the number of cores of
the process.
"""

INSTALL = "For a graphics processor of NVIDIA type: pip install 'jax[cuda12]'"

ALL = "all"
"""Every device of a kind, where a number of devices is expected."""

HOST_DEVICES = "XLA_FLAGS=--xla_force_host_platform_device_count"
"""Setting in the environment that lets the CPU count as several devices."""


class Device(Protocol):
    """A device of JAX."""

    platform: str
    id: int
    process_index: int
    device_kind: str
    client: Any


def find(name: str | None = None) -> Device:
    """The device called `cpu`, `gpu`, `cuda`, `rocm`, `tpu`, or one of several by its number: `gpu:1`.

    None: the CPU.

    Raises:
        DeviceError: there is no such device here.
    """
    if name is not None and not isinstance(name, str):
        raise DeviceError(f"a device is named by a text such as 'cpu' or 'gpu:0', not {show(name)}")
    device_name = DEFAULT if name is None else name
    kind, colon, number = device_name.lower().partition(":")
    devices = _of(kind)
    index = int(number) if number.isdecimal() else -1 if colon else 0
    if not 0 <= index < len(devices):
        raise DeviceError(
            f"this computer has no device {device_name!r}; valid names: {', '.join(names())}",
            fix="" if _of("gpu") else INSTALL,
        )
    return devices[index]


def several(count: int | str | None, kind: str | None = None) -> tuple[Device, ...]:
    """The first `count` devices of a kind (`cpu`, `gpu`, `cuda`, `rocm`, `tpu`), `all` of them, or with None
    the one that `find` returns. Hosts that have joined each give the same number of devices.

    Raises:
        DeviceError: the number is not valid, or the computer, or a host, has fewer devices of that kind.
    """
    first = find(kind)
    if count is None:
        return (first,)
    kind_name = DEFAULT if kind is None else kind.lower()
    if ":" in kind_name and count != 1:
        raise DeviceError(
            f"{kind!r} names one device, and devices={count!r} asks for several",
            fix=f"Give the kind: device={kind_name.partition(':')[0]!r}",
        )
    if ":" in kind_name:
        return (first,)
    if hosts.count() > 1:
        return _everywhere(count, kind_name)
    devices = _of(kind_name)
    if isinstance(count, str) and count == ALL:
        return tuple(devices)
    count = require_count(count)
    if count > len(devices):
        advice = f"; {HOST_DEVICES}={count} in the environment of Python divides the CPU into {count}"
        raise DeviceError(
            f"{count} devices of the kind {kind_name} are asked for, and this computer has {len(devices)}:"
            f" {', '.join(map(name, devices))}",
            fix=f"Type devices={len(devices)} or devices={ALL!r}{advice if kind_name == 'cpu' else ''}",
        )
    return tuple(devices[:count])


def of_all_hosts(count: int | str | None, kind: str | None = None) -> bool:
    """Return whether hosts that have joined share the devices that `several` returns. One that is named by
    its number is a device of this host.
    """
    return count is not None and hosts.count() > 1 and ":" not in str(kind)


def _everywhere(count: int | str, kind: str) -> tuple[Device, ...]:
    """Return devices of all hosts, of each the same number."""
    by_host = [[d for d in jax.devices(kind) if d.process_index == k] for k in range(hosts.count())]
    numbers = [len(host_devices) for host_devices in by_host]
    if isinstance(count, str) and count == ALL:
        if len(set(numbers)) > 1:
            listed = ", ".join(f"host {k}: {n}" for k, n in enumerate(numbers))
            raise DeviceError(
                f"the hosts have different numbers of devices of the kind {kind} ({listed})",
                fix=f"Type devices={min(numbers) * len(numbers)}",
            )
        share = numbers[0]
    else:
        share, remainder = divmod(require_count(count), len(numbers))
        if remainder or share > min(numbers):
            raise DeviceError(
                f"{count} devices of the kind {kind} are asked for on {len(numbers)} hosts, of which each has"
                f" at least {min(numbers)}",
                fix=f"Type a multiple of {len(numbers)} up to {min(numbers) * len(numbers)}, or {ALL!r}",
            )
    return tuple(d for host_devices in by_host for d in host_devices[:share])


def require_count(count: object) -> int:
    """Return a number of devices, or raise an error if it is none.

    Raises:
        DeviceError: it is not a whole number, at least 1.
    """
    if isinstance(count, bool) or not isinstance(count, (int, np.integer)) or count < 1:
        raise DeviceError(f"devices is {show(count)}; expected a number of devices, at least 1, or {ALL!r}")
    return int(count)


def name(device: Device) -> str:
    """Name of a device, as `find` takes it."""
    return f"{device.platform}:{device.id}"


def names() -> list[str]:
    """The devices of this machine that JAX can use."""
    unique = {name(d): None for kind in KINDS for d in _of(kind)}
    return list(unique)


def cores() -> int:
    """Return the number of cores for programs on the CPU: from the environment, else all that this process
    may use.
    """
    setting = os.environ.get(CORES, "")
    return int(setting) if setting.isdecimal() and int(setting) > 0 else available()


def available() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _of(kind: str) -> list[Device]:
    if kind not in KINDS:
        return []
    try:
        return list(jax.local_devices(backend=kind))
    except RuntimeError:  # JAX has no backend of this kind on this machine
        return []
