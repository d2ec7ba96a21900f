"""Independent tasks over processes: of this computer, or of a cluster by the address of its scheduler. The one door to dask.

Nothing here waits for ever: a scheduler that cannot be reached, one that goes away, and one without workers end in a sentence
after the seconds below; what does not shut down in time is left to die with this process.
"""

from __future__ import annotations

import logging
import socket
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from geometry.errors import InputError

CONNECT_SECONDS = 10
WORKER_SECONDS = 300
"""For how long a scheduler may be without workers, or out of reach, while runs are waiting."""
CLOSE_SECONDS = 20
POLL_SECONDS = 0.05

logger = logging.getLogger(__name__)


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
        If there is no worker to be had, or all are gone.

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
        arrived = as_completed(list(futures))
        while not arrived.is_empty():
            _await_one(arrived, client)
            future = next(arrived)
            yield futures[future], future.exception() if future.status != "finished" else future.result()
            future.release()


def _await_one(arrived: Any, client: Any) -> None:
    """Return when a result is there; an error if for :data:`WORKER_SECONDS` nobody could be working."""
    alone_since = None
    while not arrived.has_ready():
        time.sleep(POLL_SECONDS)
        alone = client.status != "running" or not client.scheduler_info()["workers"]
        alone_since = (alone_since or time.monotonic()) if alone else None
        if alone_since is not None and time.monotonic() - alone_since > WORKER_SECONDS:
            raise InputError(
                f"for {WORKER_SECONDS} s the scheduler has had no workers or was out of reach; what was finished is kept. "
                f"Start workers, such as dask worker ADDRESS, and give the same command again."
            )


@contextmanager
def _client(workers: int, scheduler: str | None) -> Iterator[Any]:
    from distributed import Client, LocalCluster

    cluster = None
    if scheduler is None:
        settings: dict[str, Any] = {"processes": True, "dashboard_address": None, "silence_logs": logging.ERROR}
        try:
            cluster = LocalCluster(n_workers=workers, threads_per_worker=1, **settings)
        except (OSError, RuntimeError, TimeoutError) as error:
            raise InputError(
                f"{workers} processes could not be started ({error}): use fewer, or --workers 1 for none."
            ) from None
    try:
        client = _connected(Client, scheduler) if scheduler is not None else Client(cluster, timeout=CONNECT_SECONDS)
        try:
            yield client
        finally:
            _close(client)
    finally:
        if cluster is not None:
            _close(cluster)


def _connected(kind: Any, scheduler: str) -> Any:
    try:
        _reach(scheduler)
        client = kind(scheduler, timeout=CONNECT_SECONDS)
    except (OSError, TimeoutError, ValueError) as error:
        raise InputError(
            f"the scheduler {scheduler} cannot be reached within {CONNECT_SECONDS} s ({error}): check the address, such as "
            f"tcp://node1:8786, or leave --scheduler out to use this computer."
        ) from None
    if not client.scheduler_info()["workers"]:
        logger.warning("the scheduler %s has no workers yet; waiting for them", scheduler)
    return client


def _close(thing: Any) -> None:
    """Close a client or a cluster, for :data:`CLOSE_SECONDS` at most."""
    try:
        thing.close(timeout=CLOSE_SECONDS)
    except Exception as error:  # the results are there; nothing is worth hanging for
        logger.warning("%s was not closed properly: %s", type(thing).__name__, error)


def _reach(scheduler: str) -> None:
    """Open and close a connection: a client that never connects leaves its threads behind."""
    from distributed.comm.addressing import get_address_host_port

    with socket.create_connection(get_address_host_port(scheduler), timeout=CONNECT_SECONDS):
        pass
