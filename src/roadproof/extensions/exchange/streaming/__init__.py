"""Monitors that take one sample at a time, in fixed memory: a plan of each formula, written as C99."""
