#!/usr/bin/python3
"""The package lists of the images hold the package of every library that a program loads.

Usage: check_run_packages.py PROGRAM LIST...      lists by their names in deploy/
"""

import pathlib
import re
import subprocess
import sys

DEPLOY = pathlib.Path(__file__).resolve().parents[2] / "deploy"
# In every Debian that has a package manager.
EVERYWHERE = {"libc6", "libgcc-s1", "libstdc++6"}


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def package_of(library):
    """The package of a library's file; dpkg may know it with or without /usr."""
    names = [library, str(pathlib.Path(library).resolve()), library.removeprefix("/usr"), f"/usr{library}"]
    for name in names:
        found = subprocess.run(["dpkg-query", "--search", name], capture_output=True, text=True)
        if found.returncode == 0:
            return found.stdout.split(":")[0]
    sys.exit(f"no package has {library}")


def main():
    program, lists = sys.argv[1], sys.argv[2:]
    lines = [line for name in lists for line in (DEPLOY / name).read_text(encoding="ascii").splitlines()]
    listed = {line.split()[0] for line in lines if line and line[0] != "#"}
    needed = re.findall(r"NEEDED.*\[(.*)\]", output("readelf", "--dynamic", program))
    paths = dict(re.findall(r"^\s*(\S+) => (/\S+)", output("ldd", program), re.MULTILINE))
    missing = {package_of(paths[name]) for name in needed if name in paths} - listed - EVERYWHERE
    if missing:
        sys.exit(f"{program} loads what {' and '.join(lists)} lack: {', '.join(sorted(missing))}")
    print(f"{' and '.join(lists)} hold what {program} loads: {len(needed)} libraries.")


main()
