#!/usr/bin/python3
"""Keeps one post in a hundred of an elevation model and makes the rest again.

Run in the root of the tree: docs/spot-comparison.py [TERRANE]

The posts kept are spot heights over a flat macro shape; H and T come from them
alone. Beside the terrain, the same spots are interpolated by inverse distance
and by a thin-plate spline. Prints two tables, one of roughness (variograms), one
of errors at the posts left out and of what shows of the spots, and leaves the
maps in out/spots. Needs Debian's python3 with numpy and gdal.
"""

import json
import os
import subprocess
import sys

import numpy as np
from osgeo import gdal

MODEL = "tests/data/jacksboro-3arcsec-4326.tif"
OUT = "out/spots"
SHARE = 0.01
SEEDS = range(1, 17)
# Level-0 cells of 64 posts: the lattice of level 6 is the model's posts.
CELL = 64
LEVEL = 6
# Pairs of spots that say how rough the ground is at a place, in posts.
NEAR = 16
LAGS = (1, 2, 4, 8, 16, 32)

gdal.UseExceptions()


class Model:
    """Heights of the elevation model and where its posts stand."""

    def __init__(self, path):
        self.dataset = gdal.Open(path)
        self.heights = self.dataset.ReadAsArray().astype(float)
        x, self.step_x, _, y, _, self.step_y = self.dataset.GetGeoTransform()
        # The world point of a post is the centre of its pixel.
        self.first_x = x + self.step_x / 2
        self.first_y = y + self.step_y / 2

    def write(self, path, heights):
        rows, columns = heights.shape
        out = gdal.GetDriverByName("GTiff").Create(
            path, columns, rows, 1, gdal.GDT_Float32, ["COMPRESS=DEFLATE"])
        out.SetGeoTransform(self.dataset.GetGeoTransform())
        out.SetProjection(self.dataset.GetProjection())
        out.GetRasterBand(1).WriteArray(heights.astype(np.float32))
        out.FlushCache()


def distances(a, b):
    """Distances of all pairs, in posts."""
    return np.hypot(a[:, None, 0] - b[None, :, 0], a[:, None, 1] - b[None, :, 1])


class SpotLikelihood:
    """How likely the process is to make the spots, by H.

    Its variogram is T/2 (h / CELL)^(2H) up to the size of a cell. Restricted
    likelihood, the one of the spots' differences: the mean does not count.
    """

    def __init__(self, posts, heights):
        self.apart = distances(posts, posts) / CELL
        # Rows below the covariance: the factorization whitens them.
        self.below = np.vstack([np.ones(len(posts)), heights - heights.mean()])

    def __call__(self, hurst):
        """Logarithm of the likelihood, and the T that is likeliest for this H."""
        count = len(self.apart)
        semivariance = 0.5 * self.apart ** (2 * hurst)
        # Any constant that makes a covariance does: it is part of the mean.
        covariance = 2 * semivariance.max() - semivariance
        root = np.linalg.cholesky(np.block(
            [[covariance, self.below.T], [self.below, np.eye(2) * 1e12]]))
        one, free = root[count:, :count]
        squares = (free @ free - (one @ free) ** 2 / (one @ one)) / (count - 1)
        logarithm = (-np.log(np.diag(root)[:count]).sum() - 0.5 * np.log(one @ one)
                     - 0.5 * (count - 1) * np.log(squares))
        return logarithm, squares


def estimate(posts, heights):
    """The likeliest H and T: H in steps of 0.1, then of 0.02 around the best."""
    likelihood = SpotLikelihood(posts, heights)
    centre = max(np.arange(0.4, 0.95, 0.1), key=lambda hurst: likelihood(hurst)[0])
    near = centre + 0.02 * np.arange(-4, 5)
    roughness = round(max(near, key=lambda hurst: likelihood(hurst)[0]), 2)
    return roughness, float(f"{likelihood(roughness)[1]:.3g}")


def local_fidelity(posts, heights, roughness):
    """T by place: sources at the corners of the cells, and what T is there.

    Of pairs at most NEAR posts apart: how their squared differences compare with
    what the process has at their distance, in a window about each corner.
    """
    i, j = np.triu_indices(len(posts), 1)
    near = distances(posts, posts)[i, j] <= NEAR
    i, j = i[near], j[near]
    middle = (posts[i] + posts[j]) / 2
    apart = np.hypot(*(posts[i] - posts[j]).T) / CELL
    ratio = (heights[i] - heights[j]) ** 2 / apart ** (2 * roughness)
    last = posts.max(axis=0)
    corners = np.array([(x, y) for y in range(0, int(last[1]) + CELL, CELL)
                        for x in range(0, int(last[0]) + CELL, CELL)], dtype=float)
    weight = np.exp(-0.5 * (distances(corners, middle) / (CELL / 2)) ** 2)
    local = weight @ ratio / weight.sum(axis=1)
    return corners, local


def write_spots(model, posts, path):
    with open(path, "w", encoding="ascii") as out:
        out.write("x,y,z\n")
        for column, row in posts:
            x = model.first_x + column * model.step_x
            y = model.first_y + row * model.step_y
            out.write(f"{x!r},{y!r},{model.heights[row, column]!r}\n")


def write_recipe(model, base, roughness, fidelity, places, path):
    rows, columns = model.heights.shape
    recipe = {
        "roughness": roughness,
        "fidelity": fidelity,
        "domain": {"cellsX": -(-(columns - 1) // CELL), "cellsY": -(-(rows - 1) // CELL)},
        "frame": {
            "originX": model.first_x, "originY": model.first_y,
            "spacingX": CELL * model.step_x, "spacingY": CELL * model.step_y,
            "crs": model.dataset.GetProjection(),
        },
        "macro": {"base": base},
        # Falloff 0 and a smooth edge: where sources overlap, T is their mean.
        "continuousConstraints": [{
            "quantity": "CONSTRAINT_QUANTITY_FIDELITY",
            "target": float(f"{target:.3g}"),
            "falloff": 0,
            "reach": 1.5 * CELL * abs(model.step_x),
            "norm": "DISTANCE_NORM_L2",
            "edge": "REACH_EDGE_SMOOTH",
            "point": {"x": model.first_x + column * model.step_x,
                      "y": model.first_y + row * model.step_y},
        } for (column, row), target in zip(*places)],
    }
    with open(path, "w", encoding="utf-8") as out:
        json.dump(recipe, out, indent=1)


def inverse_distance(posts, heights, at):
    """Weights 1 / distance^2 of the 12 nearest spots."""
    apart = distances(at, posts)
    nearest = np.argpartition(apart, 12, axis=1)[:, :12]
    weight = 1 / np.maximum(np.take_along_axis(apart, nearest, axis=1), 1e-6) ** 2
    return (weight * heights[nearest]).sum(axis=1) / weight.sum(axis=1)


class ThinPlate:
    """The spline r^2 ln r with a plane, through every spot."""

    def __init__(self, posts, heights):
        self.posts = posts
        count = len(posts)
        plane = np.column_stack([np.ones(count), posts])
        system = np.block([[self.kernel(posts), plane], [plane.T, np.zeros((3, 3))]])
        self.weights = np.linalg.solve(system, np.concatenate([heights, np.zeros(3)]))

    def kernel(self, at):
        squared = distances(at, self.posts) ** 2
        return 0.5 * squared * np.log(np.maximum(squared, 1e-300))

    def __call__(self, at):
        count = len(self.posts)
        plane = np.column_stack([np.ones(len(at)), at]) @ self.weights[count:]
        return self.kernel(at) @ self.weights[:count] + plane


def on_every_post(shape, interpolate):
    """Row by row, so that memory stays small."""
    columns = np.arange(shape[1])
    return np.array([
        interpolate(np.column_stack([columns, np.full(shape[1], row)]).astype(float))
        for row in range(shape[0])])


def variogram(heights):
    """Mean of the variograms along x and y."""
    return [(np.mean((heights[:, lag:] - heights[:, :-lag]) ** 2)
             + np.mean((heights[lag:] - heights[:-lag]) ** 2)) / 4 for lag in LAGS]


def slope(values, first, last):
    """H as the log-log slope of a variogram shows it between two lags."""
    i, j = LAGS.index(first), LAGS.index(last)
    return np.log(values[j] / values[i]) / np.log(last / first) / 2


def bend_at_spots(heights, left_out):
    """Mean squared Laplacian at the spots over that elsewhere: 1 shows no spot."""
    bend = ((heights[1:-1, :-2] + heights[1:-1, 2:] + heights[:-2, 1:-1] + heights[2:, 1:-1]) / 4
            - heights[1:-1, 1:-1]) ** 2
    inner = left_out[1:-1, 1:-1]
    return bend[~inner].mean() / bend[inner].mean()


def generate(terrane, shape, seed):
    path = f"{OUT}/seed-{seed}.tif"
    subprocess.run(
        [terrane, "terrain", "--local", "--recipe", f"{OUT}/recipe.json", "--seed", str(seed),
         "--spots", f"{OUT}/spots.csv", "--spots-level", str(LEVEL), "--level", str(LEVEL),
         "--window", f"0,0,{shape[1]},{shape[0]}", "--out", path],
        check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    subprocess.run([terrane, "verify", path, "--spots", f"{OUT}/spots.csv"], check=True,
                   stdout=subprocess.DEVNULL)
    return gdal.Open(path).ReadAsArray().astype(float)


def report(original, maps, left_out):
    print("variogram, m^2, by lag in posts; H as its slope shows it\n")
    print("| | " + " | ".join(map(str, LAGS)) + " | H, 1 to 4 | H, 4 to 16 |")
    print("| --- " * (len(LAGS) + 3) + "|")
    for name, heights in [("original", original)] + maps:
        values = variogram(heights)
        cells = [f"{value:.0f}" for value in values]
        cells += [f"{slope(values, 1, 4):.2f}", f"{slope(values, 4, 16):.2f}"]
        print(f"| {name} | " + " | ".join(cells) + " |")
    print("\nerror at the posts left out, m; squared bend at the spots over that elsewhere\n")
    print("| | root mean square | mean | bend at spots |\n| --- | --- | --- | --- |")
    for name, heights in [("original", original)] + maps:
        error = (heights - original)[left_out]
        print(f"| {name} | {np.sqrt(np.mean(error ** 2)):.1f} | {error.mean():.1f} | "
              f"{bend_at_spots(heights, left_out):.2f} |")


def main():
    terrane = sys.argv[1] if len(sys.argv) > 1 else "build/release/bin/terrane"
    os.makedirs(OUT, exist_ok=True)
    model = Model(MODEL)
    shape = model.heights.shape
    chosen = np.random.default_rng(20031).choice(
        model.heights.size, round(SHARE * model.heights.size), replace=False)
    rows, columns = np.unravel_index(np.sort(chosen), shape)
    posts = np.column_stack([columns, rows])
    heights = model.heights[rows, columns]

    roughness, fidelity = estimate(posts.astype(float), heights)
    print(f"{len(posts)} of {model.heights.size} posts; H = {roughness}, T = {fidelity:g} m^2\n")
    write_spots(model, posts, f"{OUT}/spots.csv")
    places = local_fidelity(posts.astype(float), heights, roughness)
    print(f"T by place: {places[1].min():.3g} to {places[1].max():.3g} m^2\n")
    write_recipe(model, round(float(heights.mean()), 1), roughness, fidelity, places,
                 f"{OUT}/recipe.json")
    terrains = [generate(terrane, shape, seed) for seed in SEEDS]

    nearest = on_every_post(shape, lambda at: inverse_distance(posts, heights, at))
    spline = on_every_post(shape, ThinPlate(posts.astype(float), heights))
    for name, values in [("original", model.heights), ("spot-heights", terrains[0]),
                         ("inverse-distance", nearest), ("thin-plate", spline)]:
        model.write(f"{OUT}/{name}.tif", values)

    left_out = np.ones(shape, dtype=bool)
    left_out[rows, columns] = False
    report(model.heights,
           [("spot heights", terrains[0]), ("inverse distance", nearest),
            ("thin plate", spline),
            (f"mean of {len(SEEDS)} seeds", np.mean(terrains, axis=0))], left_out)


if __name__ == "__main__":
    main()
