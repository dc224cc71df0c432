"""Scenarios and definitions as specification files; elaboration to formulas, and binding to a road.

Imports logic and world.
"""
