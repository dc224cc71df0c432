"""Assurance cases in Goal Structuring Notation: arguments whose solutions are evidence that is checked."""
