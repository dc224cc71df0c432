"""Maps in formats of other tools, and the roads that are cut from them.

May import ``world``, ``runtime`` and ``errors``.
"""
