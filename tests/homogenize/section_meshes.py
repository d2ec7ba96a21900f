"""The small sections of the benchmarks, under the name that the tests of this folder use."""

from homogenize.benchmark_sections import linear, rectangle, regions, rings, strand_section, swept, wire_trace

__all__ = ["linear", "rectangle", "regions", "rings", "strand_section", "swept", "wire_trace"]
