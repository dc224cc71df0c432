"""Least and greatest values of terms over drives, and values at which a drive appears."""
