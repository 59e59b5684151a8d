"""Start `deodar` many times at the price of one import: a process that has imported it forks for each start.

Usage: python forking.py SOCKET. Each connection to the socket sends one line of JSON: {"words", "folder",
"env"}. The first line of the answer is the number of the new process; its output follows until it ends. This
process ends when its standard input closes.
"""

import contextlib
import json
import os
import select
import signal
import socket
import sys

import deodar_studio.commands.studio  # pyright: ignore[reportUnusedImport]
import deodar_studio.web.serve  # noqa: F401  # pyright: ignore[reportUnusedImport]
from deodar.cli import main


def forked(path: str) -> bool:
    """Fork for every connection; return true in a new process, with its words in `sys.argv`, and false in
    this one at its end.
    """
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # the system removes processes that have ended
    with socket.socket(socket.AF_UNIX) as server:
        server.bind(path)
        server.listen()
        while sys.stdin not in select.select([server, sys.stdin], [], [])[0]:
            connection, _ = server.accept()
            # a test that has ended may have closed its connection
            with connection, contextlib.suppress(OSError, ValueError):
                request = json.loads(connection.makefile().readline())
                if os.fork() == 0:
                    become(connection, **request)
                    return True
    return False


def become(connection: socket.socket, words: list[str], folder: str, env: dict[str, str]) -> None:
    """Make this process one that was started by `python -m deodar WORDS` in the folder."""
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    connection.sendall(f"{os.getpid()}\n".encode())
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    for stream in (1, 2):
        os.dup2(connection.fileno(), stream)
    os.environ.clear()
    os.environ.update(env)
    os.chdir(folder)
    sys.path[0] = folder
    sys.argv[1:] = words


if __name__ == "__main__" and forked(sys.argv[1]):
    sys.exit(main())
