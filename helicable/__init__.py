"""The command line of helicable: from the drawing of a helical cable to its stiffness, its motion, and what measurements say."""

__version__ = "0.1.0"
