"""The JSON documents of requirements, assurance cases and bundles, as data classes."""
