"""Budget, progress, executors, caches, files and package data.

Imports errors only.
"""
