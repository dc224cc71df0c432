"""Arguments in Goal Structuring Notation as SVG pictures and HTML pages."""
