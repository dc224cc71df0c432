"""The search for drives: solve, round, replay, judge.

Imports encode, solve, prove and evidence.
"""
