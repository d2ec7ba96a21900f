r"""The misfit that repeats share: what is left of the residual when the noise has averaged out.

For two repeats with white residuals r_a, r_b the products r_a r_b have the expectation of the squared misfit alone, because
the noise of two records is independent. Summed over all pairs and scaled to all readings n,

.. math::  F = 1 + T / n, \qquad T = \sum r_a^T r_b ,

is the lack-of-fit ratio (1 for a true model). Its scatter is taken from sums over runs of neighbouring samples, so that
neither correlation that the noise model missed nor heavy tails make it look smaller than it is. Without repeats T is the
square residual less what the assumed noise gives.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

from compare.bench_design import Block
from effects.effect import ActiveEffect

Array = NDArray[np.float64]
_RUN = 12
ADEQUATE_Z = 3.0
GROSS_F = 1.3


@dataclass(frozen=True)
class SharedMisfit:
    """T, its standard deviation if the model were true, and the readings n it stands for."""

    T: float
    std: float
    n: int
    from_repeats: bool

    @property
    def F(self) -> float:
        """Lack-of-fit ratio, 1 for a true model."""
        return 1 + self.T / max(self.n, 1)

    @property
    def z(self) -> float:
        """T over its standard deviation."""
        return self.T / max(self.std, 1e-300)

    @property
    def adequate(self) -> bool:
        """Whether what repeats share may be noise: z below 3, and F not large, for T may sit in too few runs for a large z."""
        return self.z < ADEQUATE_Z and self.F < GROSS_F

    @property
    def p(self) -> float:
        """Chance of so much shared misfit if the model were true."""
        return float(ndtr(-self.z))


def shared_misfit(
    blocks: Sequence[Block], accepted: Sequence[Sequence[ActiveEffect]], x: Sequence[Array]
) -> SharedMisfit:
    """Of the fitted models of all blocks; x holds their coefficients."""
    total, variance, n, alone, rows = 0.0, 0.0, 0, 0.0, 0
    for block, terms, coefficients in zip(blocks, accepted, x, strict=True):
        residual = [r.target - r.whitened(terms) @ coefficients for r in block.records]
        rows += sum(len(r) for r in residual)
        alone += float(sum(r @ r for r in residual))
        for members in block.groups:
            products = [residual[i] * residual[j] for i, j in block.pairs(members)]
            if not products:
                continue
            scale = len(members) / len(products)
            runs = np.array([_runs(p) for p in products])
            total += scale * float(runs.sum())
            variance += scale**2 * float(np.sum((runs - runs.mean()) ** 2))
            n += sum(len(residual[i]) for i in members)
    if n:
        return SharedMisfit(total, float(np.sqrt(variance)), n, True)
    return SharedMisfit(alone - rows, float(np.sqrt(2.0 * rows)), rows, False)


def _runs(products: Array) -> Array:
    """Sums over runs of neighbouring samples."""
    n = len(products) // _RUN * _RUN
    return products[:n].reshape(-1, _RUN).sum(axis=1)
