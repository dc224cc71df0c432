"""The extensions of roadproof: each folder is a small product that can be left out."""
