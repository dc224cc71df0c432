"""Formulas and terms of signal temporal logic: parse, print, rewrite, classify.

Of the world it imports only signals and units.
"""
