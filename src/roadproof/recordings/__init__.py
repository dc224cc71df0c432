"""Recorded and synthetic traffic: read, converted, evaluated, simulated and exported.

May import evidence, drivers, semantics, library, world and logic.
"""
