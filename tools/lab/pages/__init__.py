"""What the reports share: reading and writing of files, plots, tables, goals. Python's own library only."""
