"""Formulas and terms of signal temporal logic (STL): parse, print, rewrite and classify them.

This package imports signals and units from ``world``, and nothing else of it.
"""
