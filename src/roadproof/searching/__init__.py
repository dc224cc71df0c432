"""Show me a drive where it holds: search, shape, round, and have it judged."""
