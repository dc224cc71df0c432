"""The answers of all questions as frozen dataclasses, one module a question.

JSON, strict reading, schemas and what ``check`` compares follow from them.
"""
