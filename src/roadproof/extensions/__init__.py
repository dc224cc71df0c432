"""What roadproof does beyond its core: each folder is a small product that can be left out."""
