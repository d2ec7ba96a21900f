"""A jerk at one end travels along the rod with the speed sqrt(EA/m) (case D4)."""

from beam.benchmark_dynamics import axial_wave


def test_wave_speed():
    """EA 471.2 kN, m 10 kg/m: 217.07 m/s; 1 %."""
    assert not [b.sentence() for b in axial_wave() if not b.passed]
