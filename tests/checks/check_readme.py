#!/usr/bin/python3
"""Runs the README's first command and holds it to the result printed below it:
check_readme.py ROOT.

The README's first block is a shell command, the next one its expected output.
The command runs in ROOT; every expected line must come, in that order, where any
number stands for any number.
"""

import pathlib
import re
import subprocess
import sys


def blocks(markdown):
  """The fenced blocks of a page as (language, text)."""
  return re.findall(r"^```(\w*)\n(.*?)^```$", markdown, re.M | re.S)


def pattern_of(line):
  """A regular expression for a line whose numbers may differ."""
  words = re.split(r"\d[\d.,]*", " ".join(line.split()))
  return re.compile(r"\d[\d.,]*".join(map(re.escape, words)))


def first_missing(expected, printed):
  """The first expected line that does not come in order, or None."""
  lines = (" ".join(line.split()) for line in printed.splitlines())
  for line in filter(str.strip, expected.splitlines()):
    pattern = pattern_of(line)
    if not any(pattern.fullmatch(candidate) for candidate in lines):
      return line
  return None


def main():
  root = pathlib.Path(sys.argv[1])
  (shell, command), (text, expected) = blocks(
      (root / "README.md").read_text())[:2]
  if (shell, text) != ("sh", "text"):
    sys.exit("README.md must open with a block of sh and its result, of text")
  run = subprocess.run(["bash", "-euc", command], cwd=root, text=True,
                       stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                       stderr=subprocess.STDOUT)
  print(run.stdout)
  if run.returncode:
    sys.exit(f"`{command.strip()}` exited with {run.returncode}")
  missing = first_missing(expected, run.stdout)
  if missing is not None:
    sys.exit(f"README.md promises this line, which did not come:\n{missing}")


if __name__ == "__main__":
  main()
