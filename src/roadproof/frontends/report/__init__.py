"""Answers as text, tables, pictures, CSV files and HTML pages.

Imports analyses for their answers; neither solvers nor the API.
"""
