"""Certificates, drive files and kept answers: written, read strictly and checked without the finders.

May import semantics, library, world and logic; never engines.
"""
