"""Certificates, drive files and other evidence: written, read strictly, and checked without the engines.

May import semantics, library, world and logic; never engines.
"""
