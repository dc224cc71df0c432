"""From which initial values a driver prevents a collision: plates with drives on both sides, and lemmas."""
