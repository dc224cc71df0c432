"""The Python API: the questions as functions, and their answers as objects.

The command line and the studio ask here.
"""
