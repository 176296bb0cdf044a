def write(d): return {}
