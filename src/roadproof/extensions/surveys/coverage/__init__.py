"""The gaps of a spec set in classes, or proofs that it has none."""
