"""The physical world: signals, units, vehicles, roads, drives and their motion.

Imports neither logic nor library.
"""
