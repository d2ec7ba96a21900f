"""One helical wire in a round rod, and three of them side by side in a matrix: the smallest sections whose parts can slide."""

import dataclasses

import numpy as np
from section_meshes import rings, wire_trace

from geometry.cell_mesh import CrossSectionMesh, Region
from geometry.material import Material

STEEP = np.radians(17.0)


def wire_in_rod(a=0.5, r=3.0, R=5.0, beta=STEEP, wire=10.0, rod=1.0, around=12, per_ring=2, straight=False):
    """Wire of radius a on a helix of radius r, lay angle beta, in a rod of radius R; moduli `wire`, `rod`, Poisson's ratio 0.3."""
    tau = 0.0 if straight else np.tan(beta) / r
    trace = wire_trace(a, r, tau)

    def shape(rho, phi):
        if rho <= a * (1 + 1e-12):
            return trace(rho, phi)
        x, y = trace(a, phi)
        along = r * np.cos(phi)
        t = -along + np.sqrt(along**2 - r * r + R * R)
        s = ((rho - a) / (R - a)) ** 1.5
        return (1 - s) * x + s * (r + t * np.cos(phi)), (1 - s) * y + s * t * np.sin(phi)

    mesh = rings((a, R), (wire, 0.3), (rod, 0.3), per_ring=per_ring, around=around, twist_rate=tau, shape=shape)
    inner, outer = mesh.regions
    names = (
        dataclasses.replace(inner, name="wire conductor"),
        dataclasses.replace(outer, name="filler", kind="interstices"),
    )
    return dataclasses.replace(mesh, regions=names)


def three_sectors(twist_rate=0.5) -> CrossSectionMesh:
    """A disc of three sectors that meet on the axis, in a sheath: points where three separated parts meet."""
    mesh = rings((1.0, 1.5), (1.0, 0.3), (1.0, 0.3), per_ring=2, around=12, twist_rate=twist_rate)
    centroid = mesh.points[mesh.cells[:, :3]].mean(axis=1)
    sector = (np.arctan2(centroid[:, 1], centroid[:, 0]) % (2 * np.pi) // (2 * np.pi / 3)).astype(int)
    region_of = np.where(mesh.region_of == 1, 3, sector)
    material = Material("m", 1.0, 0.3, 1000.0)
    kinds = [("one", "insulation"), ("two", "screen"), ("three", "cover"), ("sheath", "sheath")]
    regions = tuple(Region(name, kind, material, float("nan")) for name, kind in kinds)
    return dataclasses.replace(mesh, region_of=region_of, regions=regions)
