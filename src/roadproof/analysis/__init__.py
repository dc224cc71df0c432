"""Questions about many formulas or drives: overlap, order, redundancy, coverage, classes, catalogues.

May import all but frontends.
"""
