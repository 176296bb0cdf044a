"""Reading and writing of the tools' files: one clear line for an invalid file, and no partially written output."""
import argparse
import json
import math
import os
import pathlib
import sys


class FormatError(Exception):
    """Names the file, the place in it, and what was expected."""


class Parser(argparse.ArgumentParser):
    """Invalid flags: usage and exit status 1."""

    def error(self, message):
        self.print_usage(sys.stderr)
        print(f"{self.prog}: {message}", file=sys.stderr)
        sys.exit(1)


def run_tool(main):
    """Runs a tool's main: an invalid file ends it with one line and exit status 2."""
    try:
        sys.exit(main())
    except FormatError as error:
        print(f"{pathlib.Path(sys.argv[0]).name}: {error}", file=sys.stderr)
        sys.exit(2)


def read_bytes(path):
    try:
        return pathlib.Path(path).read_bytes()
    except OSError as error:
        raise FormatError(f"{path}: cannot be read: {error.strerror}") from None


def read_text(path):
    try:
        return read_bytes(path).decode("utf-8")
    except UnicodeDecodeError:
        raise FormatError(f"{path}: expected UTF-8") from None


def parse_json(text, where):
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        raise FormatError(f"{where}: expected JSON: {error}") from None


def read_json(path):
    return parse_json(read_text(path), path)


def read_jsonl(path):
    """Yields (where, object) for each non-empty line."""
    for number, line in enumerate(read_text(path).splitlines(), 1):
        if line.strip():
            where = f"{path}: line {number}"
            value = parse_json(line, where)
            if not isinstance(value, dict):
                raise FormatError(f"{where}: expected an object")
            yield where, value


def write_whole(path, text):
    """Writes the whole file or nothing."""
    path = pathlib.Path(path)
    part = path.with_name(path.name + f".{os.getpid()}.part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        part.write_text(text, encoding="utf-8")
        part.replace(path)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise FormatError(f"{path}: cannot be written: {error.strerror}") from None


def member(value, key, where):
    if not isinstance(value, dict) or key not in value:
        raise FormatError(f"{where}: expected \"{key}\"")
    return value[key]


def number(value, where):
    """A number; null and JSON extensions' non-numbers become NaN."""
    if value is None:
        return math.nan
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise FormatError(f"{where}: expected a number")
    return float(value)


def numbers(value, count, where):
    if not isinstance(value, list) or len(value) != count:
        raise FormatError(f"{where}: expected {count} numbers")
    return [number(part, where) for part in value]


def finite(values):
    return all(math.isfinite(value) for value in values)
