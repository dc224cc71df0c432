"""For which values of parameters and limits a formula has a drive, and how far a measure can go."""
