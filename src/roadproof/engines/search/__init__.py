"""The search for drives: solve, round to rationals, replay, judge.

Imports encode, solve, prove and evidence.
"""
