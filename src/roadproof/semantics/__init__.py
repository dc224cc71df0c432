"""The meaning of formulas on drives: exact in dense time, and on samples.

Imports library, world and logic. It shares no code with the engines, whose drives it judges.
"""
