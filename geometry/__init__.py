"""From the drawing of a cable to its geometry and its meshes. See ``read_cable`` for the way in.

Names that need gmsh, meshio, matplotlib or pyvista load them only when they are used.
"""

from geometry.bent_lay import BentLay, bent_lay, relative_turn_rate
from geometry.cable import Cable, MarkedNumber, Part, RotaryInertia
from geometry.cable_file import BuiltinCable, builtin_cables, cable_files, read_cable
from geometry.cable_table import Row, describe, marked_rows
from geometry.cell_mesh import CellBlock, CrossSectionMesh, Region, SliceMesh, SweptCell
from geometry.clearance import Clearance, Member, clearances, helix_distance
from geometry.common_period import cell_of, common_period
from geometry.conductor_section import ConductorSection, conductor_section
from geometry.cutaway_picture import draw_cutaway
from geometry.data_sheet import DataSheetRow, data_sheet_rows
from geometry.doubled_nodes import DoubledMesh, FacePairs, double_nodes
from geometry.errors import ConvergenceError, GeometryError, InputError, MeshError, SpecError
from geometry.helical_slice import helical_slice
from geometry.helix import Helix, lay_angle
from geometry.interface import Interface, interfaces, select_interfaces
from geometry.matched_lay import CommonPeriod, LayeredLay, MatchedLay
from geometry.material import Material
from geometry.mesh_file import write_mesh
from geometry.mesh_picture import draw_mesh, draw_swept_cell
from geometry.mesh_quality import element_sizes, quality_histogram, region_sizes, scaled_jacobian, share_below
from geometry.nested_cell import nested_cell
from geometry.nested_helix import CentreLine, nested_helix
from geometry.quality_picture import draw_quality
from geometry.section_mesh import cross_section_mesh
from geometry.section_picture import draw_cross_section
from geometry.self_intersection import Overlap, check_self_intersection, self_intersections
from geometry.sized_slice import slice_of_size, slice_record
from geometry.strand import Conductor, Strand
from geometry.strand_layer import StrandLayer, solve_layer
from geometry.swept_solids import Solid, write_solids
from geometry.wire_trace import WireTrace

__all__ = [
    "BentLay",
    "BuiltinCable",
    "Cable",
    "CellBlock",
    "CentreLine",
    "Clearance",
    "CommonPeriod",
    "Conductor",
    "ConductorSection",
    "ConvergenceError",
    "CrossSectionMesh",
    "DataSheetRow",
    "DoubledMesh",
    "FacePairs",
    "GeometryError",
    "Helix",
    "InputError",
    "Interface",
    "LayeredLay",
    "MarkedNumber",
    "MatchedLay",
    "Material",
    "Member",
    "MeshError",
    "Overlap",
    "Part",
    "Region",
    "RotaryInertia",
    "Row",
    "SliceMesh",
    "Solid",
    "SpecError",
    "Strand",
    "StrandLayer",
    "SweptCell",
    "WireTrace",
    "bent_lay",
    "builtin_cables",
    "cable_files",
    "cell_of",
    "check_self_intersection",
    "clearances",
    "common_period",
    "conductor_section",
    "cross_section_mesh",
    "data_sheet_rows",
    "describe",
    "double_nodes",
    "draw_cross_section",
    "draw_cutaway",
    "draw_mesh",
    "draw_quality",
    "draw_swept_cell",
    "element_sizes",
    "helical_slice",
    "helix_distance",
    "interfaces",
    "lay_angle",
    "marked_rows",
    "nested_cell",
    "nested_helix",
    "quality_histogram",
    "read_cable",
    "region_sizes",
    "relative_turn_rate",
    "scaled_jacobian",
    "select_interfaces",
    "self_intersections",
    "share_below",
    "slice_of_size",
    "slice_record",
    "solve_layer",
    "write_mesh",
    "write_solids",
]
