"""Assurance cases in Goal Structuring Notation: their elements, rules, states, limits and TOML files."""
