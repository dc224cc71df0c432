"""The command line: one module a command, found by its name.

Imports the API; only ``roadproof.__main__`` imports it.
"""
