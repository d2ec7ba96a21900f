"""The block-tridiagonal LU solves the same system as a general sparse solver."""

import numpy as np
import pytest
from scipy.sparse import bmat, csr_matrix
from scipy.sparse.linalg import spsolve

from beam.linear_solve import Factor
from beam.rod_model import Blocks


def random_blocks(nodes: int, seed: int) -> Blocks:
    rng = np.random.default_rng(seed)
    D = rng.normal(size=(nodes, 12, 12))
    return Blocks(D, rng.normal(size=(nodes - 1, 12, 12)), rng.normal(size=(nodes - 1, 12, 12)))


def assembled(blocks: Blocks) -> csr_matrix:
    n = blocks.D.shape[0]
    rows = [[None] * n for _ in range(n)]
    for i in range(n):
        rows[i][i] = csr_matrix(blocks.D[i])
        if i + 1 < n:
            rows[i][i + 1] = csr_matrix(blocks.U[i])
            rows[i + 1][i] = csr_matrix(blocks.L[i])
    return csr_matrix(bmat(rows))


@pytest.mark.parametrize("nodes", [2, 7, 40])
def test_agrees_with_scipy(nodes):
    """Unsymmetric random blocks, so that pivoting inside a block is needed; residual at round-off."""
    blocks = random_blocks(nodes, nodes)
    A = assembled(blocks)
    right = np.random.default_rng(1).normal(size=(nodes, 12))
    solution = Factor(blocks).solve(right)
    expected = np.asarray(spsolve(A.tocsc(), right.ravel())).reshape(right.shape)
    np.testing.assert_allclose(solution, expected, rtol=1e-8, atol=1e-9)  # condition numbers of 1e3 to 1e5
    assert np.abs(A @ solution.ravel() - right.ravel()).max() < 1e-10


def test_zero_on_the_diagonal_is_pivoted():
    """A block with a zero pivot is regular all the same."""
    D = np.stack([np.roll(np.eye(12), 1, axis=0), np.eye(12)])
    factor = Factor(Blocks(D, np.zeros((1, 12, 12)), np.zeros((1, 12, 12))))
    right = np.arange(24.0).reshape(2, 12)
    np.testing.assert_allclose(factor.solve(right)[0], np.roll(right[0], -1), rtol=1e-15)


def test_singular_block_is_named():
    """The node whose block cannot be eliminated is reported."""
    blocks = random_blocks(5, 0)
    blocks.D[3], blocks.L[2] = 0.0, 0.0
    assert Factor(blocks).singular_node == 3
