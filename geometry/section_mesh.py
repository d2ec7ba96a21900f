"""Mesh of the cross-section z = 0 with gmsh: every part a region, nodes shared on every interface.

Regions come from gmsh's surface tags, never from centroids. All nodes on an outline, mid-side nodes included, are put on
the exact curve (wire_trace.py); those of first-order elements beside it, so that the area is exact (area_true_curve.py).
Contacts between round parts are closed as section_outline.py says.

The mesh size is `size` in the bulk and smaller where the section asks for it: four times the thickness along
thin layers, five gap widths in necks. These factors shrink with `size`, so that halving it refines everywhere.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.area_true_curve import area_true_points
from geometry.cable import Cable
from geometry.cell_mesh import CrossSectionMesh, Region
from geometry.errors import MeshError
from geometry.gmsh_session import gmsh_session
from geometry.mesh_quality import element_sizes, scaled_jacobian
from geometry.section_outline import SectionOutline, section_outline
from geometry.wire_trace import WireTrace

KINDS = {"triangle": 1, "triangle6": 2, "quad": 1, "quad9": 2}
GMSH_TYPE = {"triangle": 2, "triangle6": 9, "quad": 3, "quad9": 10}
DEFAULT_SIZE = 1 / 26
"""Default size over outer diameter; 2.0 mm for a cable of 51.6 mm."""
LARGEST = 2e7
MOST_EDGES = 10_000
"""Edges round one thin layer."""
LARGEST_MOVE = 0.1
"""Of the thinnest layer beside a curve: how far area-true corners may leave it."""
GOOD_ENOUGH = 0.15
"""Smallest scaled Jacobian at which no other recipe is tried."""
QUAD_RECIPES: list[Mapping[str, float]] = [
    {"Algorithm": 5, "RecombinationAlgorithm": 0},
    {"Algorithm": 6, "RecombinationAlgorithm": 1, "RecombineMinimumQuality": 0.3},
    {"Algorithm": 8, "RecombinationAlgorithm": 1, "RecombineMinimumQuality": 0.5},
]


def cross_section_mesh(
    cable: Cable,
    size: float | None = None,
    kind: str = "triangle6",
    holes: Mapping[str, NDArray] | None = None,
    smallest: float = 0.0,
) -> CrossSectionMesh:
    """Mesh the section z = 0 of a cable.

    Parameters
    ----------
    cable : Cable
    size : float or None
        Edge length in the bulk [m]; None takes 1/26 of the outer diameter (2.0 mm for the reference cable, about 28 000
        displacement unknowns with "triangle6").
    kind : "triangle6" (default), "triangle", "quad" or "quad9"
    holes : parts to leave empty, by name, with the angles of the corners round each hole, growing within one turn; every edge
        between two corners is halved for quadrilaterals
    smallest : edge length [m] below which no thin layer or neck drives the size; the necks are then meshed with flat elements

    Returns
    -------
    CrossSectionMesh
        One region per part, in the order of ``cable.parts``, `closed_form_area` from the parts.

    Raises
    ------
    MeshError
        If gmsh is missing or fails, or the size is not usable.

    Examples
    --------
    >>> from geometry.cable_file import read_cable
    >>> section = cross_section_mesh(read_cable("mcpt-1.9-3.3-3x35"), size=4e-3, kind="triangle")
    >>> len(section.regions)
    17
    """
    size = cable.outer_diameter * DEFAULT_SIZE if size is None else float(size)
    _check_request(cable, size, kind)
    quads = kind.startswith("quad")
    coarse = 2 * size if quads else size  # quadrilaterals come from halving every edge of a coarser mesh
    corners = {cable.part(name).outer_trace: angles for name, angles in (holes or {}).items()}
    outline = section_outline(cable, neck_below=coarse, cuts=corners)
    outline.faces = {name: faces for name, faces in outline.faces.items() if name not in (holes or {})}
    best: CrossSectionMesh | None = None
    quality = -np.inf
    for recipe in QUAD_RECIPES if quads else [{"Algorithm": 6}]:
        mesh = _meshed(cable, outline, coarse, kind, {**recipe, "MeshSizeMin": smallest}, corners)
        worst = float(scaled_jacobian(mesh).min())
        if worst > quality:
            best, quality = mesh, worst
        if quality >= GOOD_ENOUGH:
            break
    assert best is not None
    return best


def _meshed(
    cable: Cable,
    outline: SectionOutline,
    size: float,
    kind: str,
    recipe: Mapping[str, float],
    corners: Mapping[WireTrace, NDArray],
) -> CrossSectionMesh:
    """One run of gmsh; `recipe` holds the Mesh options that differ between runs."""
    options = {
        "MeshSizeExtendFromBoundary": 1,
        "MeshSizeFromPoints": 0,
        "MeshSizeFromCurvature": 0,
        "MeshSizeMax": size,
        "MeshSizeMin": 0,
        "LcIntegrationPrecision": 1e-3,  # of the node spacing along curves; the default of 1e-9 takes most of the time
        "RecombineAll": int(kind.startswith("quad")),
        "RecombineMinimumQuality": 0.01,
        "RecombinationAlgorithm": 0,
        "SubdivisionAlgorithm": int(kind.startswith("quad")),
        "ElementOrder": 1,
        "SecondOrderIncomplete": 0,
    }
    with gmsh_session(cable.name) as gmsh:
        curve_tags, surfaces = _build(gmsh, outline)
        _set_sizes(gmsh, cable, outline, curve_tags, size, corners)
        for option, value in (options | dict(recipe)).items():
            gmsh.option.setNumber(f"Mesh.{option}", value)
        gmsh.model.mesh.generate(2)
        if KINDS[kind] == 2:
            gmsh.model.mesh.setOrder(2)
        points, cells, region_of = _read(gmsh, cable, outline, curve_tags, surfaces, kind)
    return _checked(cable, points, cells, region_of, kind)


def _check_request(cable: Cable, size: float, kind: str) -> None:
    cable.check_single_lay()
    if kind not in KINDS:
        raise MeshError(f'a cross-section cannot be meshed with "{kind}": choose one of {", ".join(KINDS)}.')
    if not (np.isfinite(size) and size > 0):
        raise MeshError(f"the mesh size must be a positive length, found {size:g} m.")
    if size > cable.outer_radius:
        raise MeshError(
            f"a mesh size of {1e3 * size:.3g} mm is larger than the cable's radius of {1e3 * cable.outer_radius:.3g} mm: "
            f"try {1e3 * cable.outer_diameter * DEFAULT_SIZE:.2g} mm."
        )
    for part in cable.parts:
        wall = part.outer_radius - part.inner_radius
        if part.kind != "interstices" and 2 * np.pi * part.outer_radius / (4 * wall) > MOST_EDGES:
            raise MeshError(
                f"{part.name} is {1e3 * wall:.3g} mm thick, too thin to be meshed round a diameter of "
                f"{2e3 * part.outer_radius:.4g} mm: leave it out, or make it at least "
                f"{1e3 * np.pi * part.outer_radius / (2 * MOST_EDGES):.2g} mm."
            )
    estimate = 2.3 * cable.area / size**2
    if estimate > LARGEST:
        raise MeshError(
            f"a mesh size of {1e3 * size:.3g} mm asks for about {estimate:.1e} elements, more than {LARGEST:.0e}: "
            f"try {1e3 * np.sqrt(2.3 * cable.area / 1e5):.2g} mm, which gives about 100 000."
        )


def _build(gmsh: Any, outline: SectionOutline) -> tuple[dict[int, int], dict[str, list[int]]]:
    """Enter the outline; returns curve of every gmsh line tag (-1 for bridges) and surface tags of every part."""
    geo = gmsh.model.geo
    needed = {abs(n) - 1 for faces in outline.faces.values() for face in faces for loop in face for n in loop}
    vertex: dict[int, int] = {}

    def point(number: int) -> int:
        if number not in vertex:
            vertex[number] = geo.addPoint(*outline.vertices[number], 0.0)
        return vertex[number]

    lines, curve_tags = {}, {}
    for number in sorted(needed):
        edge = outline.edges[number]
        ends = point(edge.tail), point(edge.head)
        if edge.curve < 0:
            lines[number] = geo.addLine(*ends)
        else:
            count = max(6, int(np.ceil(40 * (edge.end - edge.start))))
            inner = [geo.addPoint(*xy, 0.0) for xy in outline.points(edge, count)[1:-1]]
            lines[number] = geo.addSpline([ends[0], *inner, ends[1]])
        curve_tags[lines[number]] = edge.curve
    surfaces: dict[str, list[int]] = {}
    for name, faces in outline.faces.items():
        for face in faces:
            loops = [geo.addCurveLoop([int(np.sign(n)) * lines[abs(n) - 1] for n in loop]) for loop in face]
            surfaces.setdefault(name, []).append(geo.addPlaneSurface(loops))
    geo.synchronize()
    return curve_tags, surfaces


def _set_sizes(
    gmsh: Any,
    cable: Cable,
    outline: SectionOutline,
    curve_tags: dict[int, int],
    size: float,
    corners: Mapping[WireTrace, NDArray],
) -> None:
    """Mesh size as the smallest of gmsh fields: one per neck, one per curve (thickness of the layers beside it).

    Each piece of a curve with prescribed `corners` is one edge.
    """
    fineness = min(1.0, size / (cable.outer_diameter * DEFAULT_SIZE))
    along = [min(size, fineness * 2 * np.pi * curve.radius / 18) for curve in outline.curves]
    for part in cable.parts:
        if part.kind != "interstices" and part.inner_radius > 0:
            wall = part.outer_radius - part.inner_radius
            for number, curve in enumerate(outline.curves):
                if curve in (part.inner_trace, part.outer_trace):
                    along[number] = min(along[number], 4.0 * fineness * wall)
    for curve, angles in corners.items():
        number = outline.curves.index(curve)
        along[number] = 2 * np.pi * curve.radius / len(angles)
        for tag in (tag for tag, other in curve_tags.items() if other == number):
            gmsh.model.mesh.setTransfiniteCurve(tag, 2)
    field = gmsh.model.mesh.field
    fields = []
    for number, h in enumerate(along):
        fields.append(field.add("Constant"))
        field.setNumber(fields[-1], "VIn", h)
        field.setNumber(fields[-1], "VOut", size)
        field.setNumbers(fields[-1], "CurvesList", [tag for tag, curve in curve_tags.items() if curve == number])
    for neck in outline.necks:
        x, y = neck.point
        square = f"((x-({x:.12g}))^2+(y-({y:.12g}))^2)"
        fields.append(field.add("MathEval"))
        width = f"sqrt({neck.closure:.9g}^2+({neck.gap:.9g}+{neck.bend:.9g}*{square})^2)"
        field.setString(fields[-1], "F", f"{5 * fineness:.9g}*{width}")
    smallest = field.add("Min")
    field.setNumbers(smallest, "FieldsList", fields)
    field.setAsBackgroundMesh(smallest)


def _read(
    gmsh: Any,
    cable: Cable,
    outline: SectionOutline,
    curve_tags: dict[int, int],
    surfaces: dict[str, list[int]],
    kind: str,
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]:
    """Points (exact on the curves), cells and regions, numbered from 0 without orphans."""
    tags, xyz, _ = gmsh.model.mesh.getNodes()
    row = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    row[tags.astype(np.int64)] = np.arange(len(tags))
    points = xyz.reshape(-1, 3)[:, :2].copy()
    for number, curve in enumerate(outline.curves):
        edges = _edges_on_curve(gmsh, [tag for tag, on in curve_tags.items() if on == number], row)
        rows, ends = np.unique(edges, return_inverse=True)
        if len(rows) and KINDS[kind] == 2:
            points[rows] = curve.point(curve.nearest(points[rows]))
        elif len(rows):
            ends = ends.reshape(-1, 2)
            points[rows] = area_true_points(curve, points[rows], ends, LARGEST_MOVE * _thinnest_wall(cable, curve))
    width = {"triangle": 3, "triangle6": 6, "quad": 4, "quad9": 9}[kind]
    cells, region_of = [], []
    names = [part.name for part in cable.parts]
    for name, surface_tags in surfaces.items():
        for surface in surface_tags:
            types, _, nodes = gmsh.model.mesh.getElements(2, surface)
            if list(types) != [GMSH_TYPE[kind]]:
                raise MeshError(
                    f"gmsh did not fill {name} with {kind} elements only (types {list(types)}): try another size."
                )
            block = row[nodes[0].astype(np.int64)].reshape(-1, width)
            cells.append(block)
            region_of.append(np.full(len(block), names.index(name), dtype=np.int64))
    used, compact = np.unique(np.vstack(cells), return_inverse=True)
    return points[used], compact.reshape(-1, width), np.concatenate(region_of)


def _edges_on_curve(gmsh: Any, tags: list[int], row: NDArray[np.int64]) -> NDArray[np.int64]:
    """Rows of the nodes of all line elements on the pieces of a curve, (m, 2) or (m, 3) with the mid-side node."""
    found = [gmsh.model.mesh.getElements(1, tag) for tag in tags]
    blocks = [
        row[nodes[0].astype(np.int64)].reshape(len(elements[0]), -1) for _, elements, nodes in found if len(elements)
    ]
    return np.vstack(blocks) if blocks else np.zeros((0, 2), dtype=np.int64)


def _thinnest_wall(cable: Cable, curve: WireTrace) -> float:
    """Thickness of the thinnest layer beside a curve [m]; its radius if there is none."""
    walls = [
        part.outer_radius - part.inner_radius for part in cable.parts if curve in (part.inner_trace, part.outer_trace)
    ]
    return min([curve.radius, *walls])


def _checked(
    cable: Cable, points: NDArray[np.float64], cells: NDArray[np.int64], region_of: NDArray[np.int64], kind: str
) -> CrossSectionMesh:
    regions = tuple(Region(part.name, part.kind, part.material, part.area) for part in cable.parts)
    mesh = CrossSectionMesh(points, cells, kind, region_of, regions, cable.twist_rate)
    areas = element_sizes(mesh)
    if areas.min() <= 0:
        bad = int(areas.argmin())
        x, y = points[cells[bad]].mean(0)
        raise MeshError(
            f"an element of {regions[region_of[bad]].name} near ({1e3 * x:.2f}, {1e3 * y:.2f}) mm is turned inside out: try a smaller size."
        )
    return mesh
