#!/usr/bin/python3
"""Compares the ink of two pictures of one thing: same_picture.py SHOWN DRAWN.

Both are cut to what is inked and laid over each other on a coarse grid. Exits 1
when one is blank, or when less than three quarters of the ink coincides: another
program drew something else, or nothing.
"""

import sys

import numpy
from osgeo import gdal

gdal.UseExceptions()
CELLS = 40  # of the grid, a side


def ink_on_grid(path):
  """Which cells of a grid over the inked part hold ink."""
  dark = gdal.Open(path).ReadAsArray()[:3].min(axis=0) < 128
  if dark.mean() < 0.002:
    sys.exit(f"{path} is blank")
  rows, columns = numpy.where(dark)
  grid = numpy.zeros((CELLS, CELLS), bool)

  def place(values):
    low, high = values.min(), values.max()
    return ((values - low) * CELLS // (high - low + 1)).astype(int)

  grid[place(rows), place(columns)] = True
  return grid


def main():
  shown, drawn = map(ink_on_grid, sys.argv[1:3])
  common = (shown & drawn).sum() / (shown | drawn).sum()
  print(f"{common:.2f} of the ink coincides")
  sys.exit(0 if common > 0.75 else 1)


if __name__ == "__main__":
  main()
