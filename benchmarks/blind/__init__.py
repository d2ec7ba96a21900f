"""Hidden-effect bench campaigns with known truth, and the scorecard of `compare.explain` on them.

The generator (designs, truths, noise, writer) is written apart from the package `effects` and never imports it, so that
what makes the data is not what explains them; its laws are richer than a library's single forms. `baselines` and
`runner` may import `compare` and `effects`: they are on the other side of the wall, which is the campaign folder.

Run: python -m benchmarks.blind --help
"""
