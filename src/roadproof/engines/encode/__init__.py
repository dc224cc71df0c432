"""Formulas over sampled time as linear and polynomial constraints, for a search.

Imports no solver. Time becomes steps in ``unroll`` only.
"""
