"""Encoders: a formula over sampled time becomes linear and polynomial constraints for a solver.

Imports no solver. Only ``unroll`` turns time into steps.
"""
