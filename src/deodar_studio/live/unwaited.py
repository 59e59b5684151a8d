"""Threads whose work is left unfinished when the studio ends: a compilation cannot be interrupted."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor


class UnwaitedThreads(ThreadPoolExecutor):
    """Threads that nothing waits for at the end."""

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Begin no further work; what has begun continues, whatever `wait` says."""
        super().shutdown(wait=False, cancel_futures=True)

    def working(self, seconds: float) -> bool:
        """Return whether a thread still works so long after `shutdown`; those without work end at once."""
        for thread in self._threads:
            thread.join(seconds)
        return any(thread.is_alive() for thread in self._threads)
