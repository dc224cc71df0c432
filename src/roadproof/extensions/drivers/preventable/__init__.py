"""The initial values from which a driver prevents a collision: plates, drives on both sides, lemmas."""
