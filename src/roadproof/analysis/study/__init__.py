"""The frame of long analyses: pieces that are answered one by one, kept, and taken up again.

Imports no analysis, and neither the prover nor the search.
"""
