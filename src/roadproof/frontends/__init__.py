"""What users see: the Python API, the command line, the studio, and reports.

May import everything; nothing imports it.
"""
