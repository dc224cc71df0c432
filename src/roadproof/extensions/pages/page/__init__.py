"""Report pages: one HTML file of saved answers, with matrices, plates and a drive viewer."""
