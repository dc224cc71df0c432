"""The atlas: static pages about all scenarios, with moving pictures and the evidence for each statement."""
