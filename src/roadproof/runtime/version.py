"""The version of roadproof, which pyproject.toml reads from here."""

VERSION = "1.0.0rc1"
ANSWERS = "0.1.0"
"""The first version whose answers are those of this one: shipped and kept answers since then are taken.

Raise it to ``VERSION`` with every change after which a question may have another answer.
"""
