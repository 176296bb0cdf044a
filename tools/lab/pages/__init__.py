"""Shared parts of the reports: reading and writing of files, plots, tables, goals. Uses only Python's standard library."""
