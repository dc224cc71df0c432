"""Which disturbances a spec set misses: proofs that it misses none, or its gaps in classes."""
