"""The search engines: they find proofs, countermodels and drives.

Nothing rests on them: ``evidence`` checks their certificates, and ``semantics`` judges their drives.
May import evidence, semantics, library, world and logic.
"""
