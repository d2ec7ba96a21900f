"""Products of matrices in small dense blocks, row by row with a marker of columns (Gustavson, ACM Trans. Math. Softw. 4 (1978) 250-269,
doi 10.1145/355791.355796), on two threads."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp

from homogenize.block_sweep import halves
from homogenize.compiled import kernel, share


def block_product(A: Any, B: Any) -> sp.bsr_matrix:
    """A B of two BSR matrices; columns of the result are not sorted."""
    rows, columns = A.shape[0] // A.blocksize[0], B.shape[1] // B.blocksize[1]
    ranges = halves(A.indptr)
    found = np.zeros(rows + 1, dtype=np.int64)
    share(_count, ranges, A.indptr, A.indices, B.indptr, B.indices, found, columns)
    indptr = np.cumsum(found).astype(np.int32)
    shape = (A.blocksize[0], A.blocksize[1], B.blocksize[1])
    indices = np.empty(indptr[-1], dtype=np.int32)
    data = np.zeros((indptr[-1], shape[0], shape[2]), dtype=np.result_type(A.data.dtype, B.data.dtype))
    units = tuple((0,) * k for k in shape)
    share(
        _fill, ranges, A.indptr, A.indices, A.data, B.indptr, B.indices, B.data, indptr, indices, data, columns, *units
    )
    return sp.bsr_matrix((data, indices, indptr), shape=(A.shape[0], B.shape[1]))


@kernel
def _count(first, last, a_start, a_column, b_start, b_column, found, columns):
    seen = np.full(columns, -1, np.int64)
    for i in range(first, last):
        n = 0
        for k in range(a_start[i], a_start[i + 1]):
            j = a_column[k]
            for m in range(b_start[j], b_start[j + 1]):
                c = b_column[m]
                if seen[c] != i:
                    seen[c] = i
                    n += 1
        found[i + 1] = n


@kernel
def _fill(first, last, a_start, a_column, a, b_start, b_column, b, start, column, out, columns, high, inner, wide):
    place = np.full(columns, -1, np.int64)
    for i in range(first, last):
        end = start[i]
        for k in range(a_start[i], a_start[i + 1]):
            j = a_column[k]
            for m in range(b_start[j], b_start[j + 1]):
                c = b_column[m]
                if place[c] < start[i]:
                    place[c] = end
                    column[end] = c
                    end += 1
                s = place[c]
                for p in range(len(high)):
                    for q in range(len(inner)):
                        f = a[k, p, q]
                        for r in range(len(wide)):
                            out[s, p, r] += f * b[m, q, r]
