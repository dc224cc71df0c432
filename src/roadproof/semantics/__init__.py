"""What formulas mean on drives: exactly in dense time, and on samples.

Imports library, world and logic. It shares no code with the engines, whose answers it judges.
"""
