"""The Python API, the command line and reports.

May import all rooms of the core, of which none imports it; extensions do.
"""
