#!/bin/sh
# check_format.sh SOURCE: every C++ file is as clang-format (14) writes it. 77: the tool is missing.
set -eu
cd "$1"
tool=$(command -v clang-format-14 || command -v clang-format) || { echo "Skipped: clang-format is missing (scripts/setup test installs it)."; exit 77; }
find include src planners tests python bench -name '*.?pp' -o -name '*.inl' | sort | xargs "$tool" --dry-run -Werror
