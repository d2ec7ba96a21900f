"""Independent tasks over processes: of this computer, or of a cluster by the address of its scheduler. The one door to dask."""

from __future__ import annotations

import logging
import socket
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from geometry.errors import InputError

CONNECT_SECONDS = 10


def finished(
    function: Callable[..., Any], tasks: Sequence[tuple[Any, ...]], *, workers: int = 1, scheduler: str | None = None
) -> Iterator[tuple[int, Any]]:
    """(number of the task, its result) as they finish; the result is an exception if the task or its worker broke.

    Parameters
    ----------
    function : callable
        Of a module that the workers can import.
    tasks : sequence of tuple
        Its arguments.
    workers : int
        Processes; with one, and without a scheduler, the tasks run here one after the other.
    scheduler : str, optional
        Address of a running scheduler.

    Raises
    ------
    InputError
        If there is no worker to be had.

    Examples
    --------
    >>> list(finished(pow, [(2, 3), (3, 2)]))
    [(0, 8), (1, 9)]
    """
    if workers < 1:
        raise InputError(f"{workers} workers cannot run anything; give one or more.")
    if not tasks:
        return
    if scheduler is None and workers == 1:
        for k, task in enumerate(tasks):
            yield k, function(*task)
        return
    from distributed import as_completed

    with _client(min(workers, len(tasks)), scheduler) as client:
        futures = {client.submit(function, *task, pure=False, retries=1): k for k, task in enumerate(tasks)}
        for future in as_completed(list(futures)):
            yield futures[future], future.exception() if future.status != "finished" else future.result()
            future.release()


@contextmanager
def _client(workers: int, scheduler: str | None) -> Iterator[Any]:
    from distributed import Client, LocalCluster

    if scheduler is None:
        settings: dict[str, Any] = {"processes": True, "dashboard_address": None, "silence_logs": logging.ERROR}
        with LocalCluster(n_workers=workers, threads_per_worker=1, **settings) as cluster, Client(cluster) as client:
            yield client
        return
    try:
        _reach(scheduler)
        client = Client(scheduler, timeout=CONNECT_SECONDS)
    except (OSError, TimeoutError, ValueError) as error:
        raise InputError(
            f"the scheduler {scheduler} cannot be reached within {CONNECT_SECONDS} s ({error}): check the address, such as "
            f"tcp://node1:8786, or leave --scheduler out to use this computer."
        ) from None
    with client:
        if not client.scheduler_info()["workers"]:
            logging.getLogger(__name__).warning("the scheduler %s has no workers yet; waiting for them", scheduler)
        yield client


def _reach(scheduler: str) -> None:
    """Open and close a connection: a client that never connects leaves its threads behind."""
    from distributed.comm.addressing import get_address_host_port

    with socket.create_connection(get_address_host_port(scheduler), timeout=CONNECT_SECONDS):
        pass
