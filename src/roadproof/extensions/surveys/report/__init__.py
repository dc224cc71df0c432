"""Texts, tables and pictures of surveys."""
