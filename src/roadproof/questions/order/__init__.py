"""The implications between scenarios: every one proved, every other one refuted by a drive."""
