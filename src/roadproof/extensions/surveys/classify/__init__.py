"""Mutually exclusive classes of scenarios, with a drive for each and proofs about them."""
