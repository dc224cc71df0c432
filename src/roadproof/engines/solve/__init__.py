"""Solvers, each in one module: z3 and cvc5, cvxpy with HiGHS, and Clarabel.

Imports neither logic nor library.
"""
