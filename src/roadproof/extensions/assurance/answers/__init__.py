"""What answers about requirements, cases and bundles say, as JSON has it."""
