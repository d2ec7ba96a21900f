"""The zone of a cross-section in which laid parts stand: its curves, its filler, and the layers that closures join.

One zone is meshed: all laid parts of the cable, between a centre (or none) and the circle round them (or none).
"""

from __future__ import annotations

from geometry.cable import Cable, Part
from geometry.errors import MeshError
from geometry.wire_trace import WireTrace


def curve_key(trace: WireTrace) -> tuple[float, float, float]:
    """What two traces of one curve have in common."""
    return (
        round(trace.centre_radius, 12),
        round(trace.phase if trace.centre_radius > 0 else 0.0, 9),
        round(trace.radius, 12),
    )


def the_filler(cable: Cable) -> Part | None:
    """The part between the laid parts, None if the gaps are empty."""
    fillers = [part for part in cable.parts if part.kind == "interstices"]
    if len(fillers) > 1:
        raise MeshError(
            f"{cable.name}: {fillers[0].name} and {fillers[1].name} cannot be meshed in one section, which has one filler: "
            "leave one of them out."
        )
    return fillers[0] if fillers else None


def zone_curves(
    cable: Cable, index: dict[tuple[float, float, float], int]
) -> tuple[list[int], int | None, int | None] | None:
    """Curves that bound the gaps: laid parts, centre (or None), circle round them (or None); None if the cable is coaxial."""
    laid = {
        part.member: part for part in cable.parts if part.centre_radius > 0
    }  # the last of a member is its outermost
    if not laid:
        return None
    low = min(part.centre_radius for part in laid.values())
    high = max(part.centre_radius for part in laid.values())
    coaxial = [part for part in cable.parts if part.centre_radius == 0 and part.kind != "interstices"]
    between = [part.name for part in coaxial if low < part.outer_radius < high]
    if between:
        raise MeshError(
            f"{cable.name}: {between[0]} lies between two layers of laid parts; a section with one such layer is meshed so far: "
            "try a cable file with one of the layers."
        )
    filler = the_filler(cable)
    apart = [] if filler is None else [p.name for p in laid.values() if p.centre_radius > filler.outer_radius]
    if filler is not None and apart:
        raise MeshError(
            f"{cable.name}: {apart[0]} lies outside the {filler.name}; a section with one layer of laid parts is meshed so far: "
            "leave the filler out, or try a cable file with one of the layers."
        )
    cores = [index[curve_key(part.outer_trace)] for part in laid.values()]
    inside = [part.outer_radius for part in coaxial if part.outer_radius <= low]
    outside = [part.inner_radius for part in coaxial if part.inner_radius >= high]
    outside += [part.outer_radius for part in cable.parts if part.kind == "interstices"]
    circle = [
        index[(0.0, 0.0, round(radius, 12))]
        for radius in (max(inside, default=0.0), min(outside, default=0.0))
        if radius
    ]
    centre = circle[0] if inside else None
    return cores, centre, circle[-1] if outside else None


def host_area(cable: Cable, curve: WireTrace, outer: bool) -> float:
    """Area of the layer that gets the closures on this curve: outside the `outer` circle, inside any other curve."""
    for part in cable.parts:
        trace = part.inner_trace if outer else part.outer_trace
        if part.kind != "interstices" and trace is not None and curve_key(trace) == curve_key(curve):
            return part.area
    return cable.area  # nothing lies round the filler: a closure only ends it bluntly
