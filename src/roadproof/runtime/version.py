"""The version of roadproof, which pyproject.toml reads from here."""

VERSION = "1.0.0rc1"
ANSWERS = "0.1.0"
"""The first version whose answers are still valid: shipped and cached answers since then are used.

Raise it to ``VERSION`` with every change that can change the answer to a question.
"""
