"""Specification files with definitions and scenarios; elaboration to formulas, and binding to a road.

Imports logic and world.
"""
