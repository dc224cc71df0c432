"""Arguments in Goal Structuring Notation as pictures and pages."""
