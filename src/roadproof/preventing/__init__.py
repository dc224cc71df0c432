"""Preventable or not: drivers of regulations over planes of initial values, exactly."""
