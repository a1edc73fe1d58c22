#!/usr/bin/python3
"""deploy/apt-packages-run.txt holds the package of every library that the programs load.

Usage: check_run_packages.py PROGRAM...
"""

import pathlib
import re
import subprocess
import sys

LIST = pathlib.Path(__file__).resolve().parents[2] / "deploy" / "apt-packages-run.txt"
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
    listed = {line.split()[0] for line in LIST.read_text(encoding="ascii").splitlines() if line and line[0] != "#"}
    missing = set()
    for program in sys.argv[1:]:
        needed = re.findall(r"NEEDED.*\[(.*)\]", output("readelf", "--dynamic", program))
        paths = dict(re.findall(r"^\s*(\S+) => (/\S+)", output("ldd", program), re.MULTILINE))
        missing |= {package_of(paths[name]) for name in needed if name in paths} - listed - EVERYWHERE
    if missing:
        sys.exit(f"not in deploy/apt-packages-run.txt, but loaded: {', '.join(sorted(missing))}")
    print(f"{len(listed)} packages hold what {len(sys.argv) - 1} programs load.")


main()
