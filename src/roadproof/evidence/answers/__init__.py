"""The JSON answers of all questions as frozen dataclasses, one module for each kind of question.

The JSON writer, the strict reader, the schemas and the comparison in ``check`` are derived from them.
"""
