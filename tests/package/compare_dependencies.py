"""What CMake finds, what package.xml names for rosdep, what scripts/setup installs and what libposewright-dev depends on are the same:
compare_dependencies.py SOURCE BUILD. The second road: dpkg says which package each file is from that CMake found in BUILD."""
import pathlib
import re
import subprocess
import sys
import xml.etree.ElementTree as xml

source, build = map(pathlib.Path, sys.argv[1:])

# Key of rosdep: Debian package, as rosdep/base.yaml of ros/rosdistro has them (ompl: Debian's name of what ROS releases itself).
ROSDEP = {
    "assimp-dev": "libassimp-dev", "eigen": "libeigen3-dev", "fmt": "libfmt-dev", "libboost-dev": "libboost-dev",
    "libboost-program-options-dev": "libboost-program-options-dev",
    "libfcl-dev": "libfcl-dev", "libnlopt-cxx-dev": "libnlopt-cxx-dev", "libnlopt-dev": "libnlopt-dev", "libqhull": "libqhull-dev",
    "nlohmann-json-dev": "nlohmann-json3-dev", "ompl": "libompl-dev", "tinyxml2": "libtinyxml2-dev",
    "yaml-cpp": "libyaml-cpp-dev", "zlib": "zlib1g-dev"}
# What no find_package() names: nlopt.hpp is in a package of its own; libassimp's CMake file names libz.so.
BESIDE = {"libnlopt-cxx-dev", "zlib1g-dev"}
# libboost-dev and libboost-program-options-dev bring those of their version, whose files CMake finds.
VERSIONED = re.compile(r"^(libboost)[\d.]+(-dev)$|^(libboost-program-options)[\d.]+(-dev)$")

keys = [depend.text for depend in xml.parse(source / "package.xml").getroot().findall("depend")]
assert sorted(set(keys)) == keys, f"package.xml: {keys}"
assert set(keys) <= set(ROSDEP), f"no key of rosdep is known: {set(keys) - set(ROSDEP)}"
named = {ROSDEP[key] for key in keys}

setup = (source / "scripts/setup").read_text()
installed = {word for word in re.search(r"packages='(.*?)'", setup, re.S).group(1).split() if word.endswith("-dev")}
# Its objects become part of the library, and a build can do without: rosdep has no key for it.
installed.remove("musl-dev")
assert named == installed, f"package.xml and scripts/setup differ in {named ^ installed}"

development = (source / "cmake/packaging/development.cmake").read_text()
depends = set(re.findall(r"[\w+.-]+-dev\b", re.search(r'DEPENDS "(.*?)"', development, re.S).group(1)))
assert named == depends, f"package.xml and libposewright-dev differ in {named ^ depends}"

cache = (build / "CMakeCache.txt").read_text()
found = {}
for name in re.findall(r"^find_package\((\S+)", (source / "cmake/dependencies.cmake").read_text(), re.M):
    if name == "Threads":  # of the C library
        continue
    folder = re.search(rf"^{re.escape(name)}_DIR:PATH=(.*)", cache, re.M)
    assert folder, f"CMake's cache has no {name}_DIR"
    said = subprocess.run(["dpkg", "-S", str(pathlib.Path(folder[1])), str(pathlib.Path(folder[1]).resolve())], capture_output=True, text=True).stdout
    owners = {VERSIONED.sub(r"\1\2\3\4", owner.split(":")[0]) for line in said.splitlines() for owner in line.rpartition(": ")[0].split(", ")}
    assert owners & named, f"{name}: {folder[1]} is of {owners}, none of which package.xml names"
    found |= {owner: name for owner in owners & named}
rest = named - set(found) - BESIDE - {"libboost-program-options-dev"}
assert not rest, f"nothing that CMake finds needs {rest}"
assert "program_options" in (source / "cmake/dependencies.cmake").read_text()
