#!/usr/bin/env python3
"""Writes COUNT mutated files beside the seeds of every format in tests/fuzz/corpus. The test FuzzCorpus then replays them; with the preset
asan, under ASan and UBSan. Afterwards `git clean -fd tests/fuzz/corpus` removes them.

usage: tests/fuzz/mutate.py COUNT SEED
"""
import random
import sys
from pathlib import Path

CORPUS = Path(__file__).resolve().parent / "corpus"
WORDS = [b"nan", b"-1", b"1e308", b"18446744073709551616", b"null", b"[]", b"{}", b'""', b"\x00", b"\xff\xff\xff\xff", b"4294967295", b"-0",
         b"1e-320", b"true", b"\\u0000", b"../../x", b","]


def change(data: bytearray, seeds: list[bytes], rng: random.Random) -> None:
    """One random edit: a byte, a bit, a deletion, a word, a piece of another seed, or a repetition."""
    at = rng.randrange(len(data) + 1)
    kind = rng.randrange(7)
    if kind == 0 and at < len(data):
        data[at] = rng.randrange(256)
    elif kind == 1 and at < len(data):
        data[at] ^= 1 << rng.randrange(8)
    elif kind == 2:
        del data[at:at + rng.randint(1, 40)]
    elif kind == 3:
        data[at:at] = rng.choice(WORDS)
    elif kind == 4:
        data[at:at + rng.randint(1, 12)] = rng.choice(WORDS)
    elif kind == 5:
        other = rng.choice(seeds)
        begin = rng.randrange(len(other) + 1)
        data[at:at] = other[begin:begin + rng.randint(1, 200)]
    elif kind == 6:
        begin = rng.randrange(len(data) + 1)
        data[at:at] = data[begin:begin + rng.randint(1, 100)]


def main(count: int, seed: int) -> None:
    rng = random.Random(seed)
    for folder in sorted(path for path in CORPUS.iterdir() if path.is_dir()):
        seeds = [file.read_bytes() for file in sorted(folder.iterdir()) if not file.name.startswith("mutated_")]
        for i in range(count if seeds else 0):
            data = bytearray(rng.choice(seeds))
            for _ in range(rng.randint(1, 6)):
                change(data, seeds, rng)
            if rng.random() < 0.1:
                del data[rng.randrange(len(data) + 1):]
            (folder / f"mutated_{i:05d}").write_bytes(bytes(data))


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
