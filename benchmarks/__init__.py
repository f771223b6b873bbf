"""Speed, measured side by side with other programs, in one run on one machine: never part of the tests.

`python -m benchmarks` runs it all; `__main__.py` lists the parts, a file each.
"""
