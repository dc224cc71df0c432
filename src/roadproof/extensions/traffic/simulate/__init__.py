"""Synthetic recordings, with planted scenarios."""
