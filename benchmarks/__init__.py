"""Speed, measured side by side with other programs, in one run on one machine. Not part of the tests.

`python -m benchmarks` runs all parts; `__main__.py` lists them, one file each.
"""
