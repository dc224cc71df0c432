"""Driver models of regulations as exact formulas over initial values: which disturbances they prevent.

Imports semantics, library, world and logic; neither evidence nor engines.
"""
