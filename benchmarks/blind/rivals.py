"""The nearest rival of a single truth: how far the truth is from the closest other effect, in units of the noise.

Rivals are drawn at random from the generator's own laws, at the same share, and scaled to fit best; the distance is thus
an upper limit. Below about five, data of this size cannot tell the two apart, and a set is as right as the name.
"""

from __future__ import annotations

import numpy as np

from benchmarks.blind.bench import Bench
from benchmarks.blind.noise import Noise
from benchmarks.blind.strength import main_change, of_share, share_not_linear
from benchmarks.blind.ties import untestable
from benchmarks.blind.truth import Truth
from benchmarks.blind.truths import LIBRARY

_DRAWS = 3
_EITHER_SIGN = ("sensor-offset", "sensor-drift", "direction-asymmetry")


def nearest_rival(rng: np.random.Generator, bench: Bench, noise: Noise, truth: Truth, clock: bool) -> tuple[str, float]:
    """Name and distance of the closest rival; both repeats counted.

    Parameters
    ----------
    rng : Generator
        For the numbers of the rivals.
    bench : Bench
        Conditions.
    noise : Noise
        Of the main channel.
    truth : Truth
        Alone in the campaign.
    clock : bool
        Whether time was recorded: without it there are no effects of rate.
    """
    e = main_change(bench, noise, [truth])
    size, share = float(np.linalg.norm(e)), share_not_linear(bench, [truth])
    found = ("", np.sqrt(2) * size)
    for name, law in LIBRARY.items():
        if name == truth.effect or bench.kind not in law.kinds or untestable(name, bench, clock, second_channel=False):
            continue
        for variant in law.variants:
            for _ in range(_DRAWS):
                rival = of_share(bench, law.draw(rng, bench, variant), share, close=0.2)
                r = main_change(bench, noise, [rival], like=[truth])
                fit = float(e @ r) / (float(np.linalg.norm(r)) + 1e-30)
                fit = abs(fit) if name in _EITHER_SIGN else max(fit, 0.0)
                left = float(np.sqrt(2 * max(size**2 - fit**2, 0.0)))
                if left < found[1]:
                    found = (name, left)
    return found
