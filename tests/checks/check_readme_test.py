#!/usr/bin/python3
"""Tests of check_readme.py."""

import unittest

import check_readme

PAGE = """# T

```sh
a.sh
```

prints

```text
wrote 3 files
took 1.5 s
```
"""


class CheckReadmeTest(unittest.TestCase):

  def test_blocks_are_found_with_their_language(self):
    self.assertEqual([("sh", "a.sh\n"), ("text", "wrote 3 files\ntook 1.5 s\n")],
                     check_readme.blocks(PAGE))

  def test_numbers_may_differ(self):
    self.assertIsNone(check_readme.first_missing(
        "wrote 3 files\ntook 1.5 s\n", "x\nwrote  12 files\ny\ntook 0.25 s\n"))

  def test_words_and_order_may_not(self):
    for printed in ("", "wrote 3 files\n", "took 1 s\nwrote 3 files\n",
                    "wrote some files\ntook 1 s\n"):
      with self.subTest(printed=printed):
        self.assertIsNotNone(check_readme.first_missing(
            "wrote 3 files\ntook 1.5 s\n", printed))


if __name__ == "__main__":
  unittest.main()
