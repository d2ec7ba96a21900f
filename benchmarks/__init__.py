"""Time and memory of the cell and of the rod, as ratios within one run; see each file for its table."""
