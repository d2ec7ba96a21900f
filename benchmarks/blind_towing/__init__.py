"""Hidden-effect towing campaigns with known truth, and the score of `compare.explain` on them.

Nothing here shares code with the model that explains: the line is a chain of finite volumes with an implicit-explicit
Newmark step (:mod:`~benchmarks.blind_towing.towed_line`), checked against a chain in Exudyn
(:mod:`~benchmarks.blind_towing.exudyn_line`), which makes the shipped data. `compare` and `effects` are imported only
where an answer is scored.
"""
