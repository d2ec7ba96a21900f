"""How a computation ended: an enumeration of sentences, so that a failed run is a value that can be kept and shown."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from geometry.errors import ConvergenceError


class Status(Enum):
    """Why a static or a dynamic computation stopped."""

    COMPLETED = "completed"
    NOT_CONVERGED = "stopped: the iteration did not converge even at the smallest step"
    NOT_FINITE = "stopped: a force became NaN or infinite"


@dataclass(frozen=True)
class Outcome:
    """A status and the sentence that says where, how much, and what to try (empty when completed)."""

    status: Status = Status.COMPLETED
    detail: str = ""

    @property
    def completed(self) -> bool:
        """True if the end was reached."""
        return self.status is Status.COMPLETED

    def __str__(self) -> str:
        return self.status.value + (f". {self.detail}" if self.detail else "")

    def require_success(self) -> None:
        """Raise :class:`ConvergenceError` with the sentence unless the end was reached."""
        if not self.completed:
            raise ConvergenceError(str(self))
