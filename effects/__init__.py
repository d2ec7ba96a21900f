"""The library of effects that a linear cable model leaves out: physics, rig and sensor, one file each."""
