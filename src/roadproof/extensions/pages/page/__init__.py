"""The HTML page of saved answers, with matrices, plates and a viewer of drives."""
