r"""Interfaces that slide without opening, built into the unknowns.

The nodes of the separated interfaces are doubled (:mod:`homogenize.doubled_nodes`). A copy moves like the node it is linked to plus
a slip s = (s_a, s_b) along the two tangents of the helical surface,

.. math::  u_{copy} = u_{partner} + a\, s_a + b\, s_b , \qquad\text{so that}\quad N \cdot [u] = 0

needs no penalty: u = T (u_original, s) and K becomes T^T K T. N does not depend on z, and the same T serves tension, torsion, bending
and shear. Slips that cost nothing are the frictionless interface; a law adds its forces to s; s = 0 is the bonded section.
Where a law lets the parts open (:mod:`homogenize.opening_contact`) a third unknown g >= 0 moves the copy away, by -N g.

A part that slides in its hole can move freely (:mod:`homogenize.free_motion`). These motions store no energy and no load does work on
them; they are pinned in the z-independent problem, and named.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from geometry.cell_mesh import CrossSectionMesh
from homogenize.doubled_nodes import DoubledNodes, doubled_nodes
from homogenize.free_motion import free_motions, pins
from homogenize.interface_choice import InterfaceLaw, Interfaces
from homogenize.section_field import FloatArray, SectionField


@dataclass(frozen=True)
class Frictionless:
    """No tangential traction and no opening."""

    @property
    def holds(self) -> bool:
        """Never resists a slip."""
        return False

    def describe(self) -> str:
        """The law in words."""
        return "frictionless"


@dataclass(frozen=True)
class SlidingField:
    """A section field whose parts slide, and the unknowns that are left.

    Attributes
    ----------
    field : with doubled nodes
    T : (3 n, unknowns) values of the doubled field from the free unknowns: those of the original nodes, the slips, the openings
    Z : (unknowns, 6) rigid motions in the free unknowns
    slip_pins : unknowns that are pinned in the z-independent problem, one for each free motion of a part
    free_motions : the same motions in words
    anchored : (n_original,) nodes of the body that holds the gauge of the whole section
    doubled : the links between the copies; the slip of link l are unknowns first_slip + 2 l and + 1
    laws : names and laws, numbered as in ``doubled.law``
    opening : links that can open; the last unknowns are theirs, one each
    undoubled : the field before the nodes were doubled
    """

    field: SectionField
    T: sp.csr_array
    Z: FloatArray
    slip_pins: tuple[int, ...]
    free_motions: tuple[str, ...]
    anchored: NDArray[np.bool_]
    doubled: DoubledNodes
    laws: Mapping[str, InterfaceLaw]
    opening: NDArray[np.int64]
    undoubled: SectionField

    @property
    def first_slip(self) -> int:
        """Number of the first slip unknown: three for each original node come before."""
        return self.first_opening - 2 * len(self.doubled.child)

    @property
    def first_opening(self) -> int:
        """Number of the first opening unknown."""
        return len(self.Z) - len(self.opening)

    def links_of(self, kind: type) -> NDArray[np.int64]:
        """Links whose law is of a class."""
        wanted = [isinstance(law, kind) for law in self.laws.values()]
        return np.flatnonzero(np.array(wanted)[self.doubled.law])

    def slips_of(self, links: NDArray[np.int64]) -> NDArray[np.int64]:
        """Slip unknowns of links, two by two."""
        return (self.first_slip + 2 * links[:, None] + np.arange(2)).ravel()

    def constant_of_links(self, name: str) -> FloatArray:
        """A constant of the laws, by the name of its attribute, for each link; 0 where the law has none."""
        return np.array([getattr(law, name, 0.0) for law in self.laws.values()])[self.doubled.law]


def sliding_field(field: SectionField, mesh: CrossSectionMesh, interfaces: Interfaces) -> SlidingField:
    """Separate the parts that are named, so that they can slide on each other.

    Raises
    ------
    MeshError
        If the mesh is not made of triangles, or a name does not fit the parts.
    """
    doubled = doubled_nodes(field, interfaces.separated(mesh))
    holds = np.array([law.holds for law in interfaces.laws.values()])[doubled.law]
    motions = free_motions(field, mesh, doubled, holds)
    n = field.nodes.shape[1]
    slips = np.zeros((2 * len(doubled.child), motions.displacement.shape[1]))
    if slips.size:
        u = motions.displacement.reshape(-1, 3, slips.shape[1])
        jump = u[doubled.child] - u[doubled.parent]
        slips = np.einsum("kxl,lxm->lkm", doubled.frame[1:], jump).reshape(slips.shape)
    opening = np.flatnonzero(np.array([getattr(law, "opens", False) for law in interfaces.laws.values()])[doubled.law])
    closed = np.zeros((len(opening), slips.shape[1]))
    in_unknowns = np.concatenate([motions.displacement[: 3 * n], slips, closed])
    rigid = field.rigid_motion()
    return SlidingField(
        field=replace(field, nodes=doubled.nodes, cells=doubled.cells),
        T=_transfer(doubled, n, opening),
        Z=np.concatenate([rigid, np.zeros((2 * len(doubled.child) + len(opening), 6))]),
        slip_pins=pins(in_unknowns),
        free_motions=motions.sentences,
        anchored=motions.at_rest[:n],
        doubled=doubled,
        laws=dict(interfaces.laws),
        opening=opening,
        undoubled=field,
    )


def _transfer(doubled: DoubledNodes, n: int, opening: NDArray[np.int64]) -> sp.csr_array:
    """T: a copy is the node at the root of its links plus the slips and openings on the way."""
    first_opening = 3 * n + 2 * len(doubled.child)
    column_of = {int(link): first_opening + k for k, link in enumerate(opening)}
    link_of = {int(child): i for i, child in enumerate(doubled.child)}
    rows, columns, values = [np.arange(3 * n)], [np.arange(3 * n)], [np.ones(3 * n)]
    for start in link_of:
        node = start
        while node in link_of:
            i = link_of[node]
            rows.append(np.repeat(3 * start + np.arange(3), 2))
            columns.append(np.tile(3 * n + 2 * i + np.arange(2), 3))
            values.append(doubled.frame[1:, :, i].T.ravel())
            if i in column_of:
                rows.append(3 * start + np.arange(3))
                columns.append(np.full(3, column_of[i]))
                values.append(-doubled.frame[0, :, i])
            node = int(doubled.parent[i])
        rows.append(3 * start + np.arange(3))
        columns.append(3 * node + np.arange(3))
        values.append(np.ones(3))
    shape = (3 * doubled.nodes.shape[1], first_opening + len(opening))
    return sp.coo_array((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=shape).tocsr()
