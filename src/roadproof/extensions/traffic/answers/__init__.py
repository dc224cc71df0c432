"""What answers about recordings and traces say, as JSON has it."""
