#!/bin/sh
# check_format.sh SOURCE: every C++ file is as clang-format 14 writes it. 77: the tool is missing.
set -eu
cd "$1"
# Each version has its own idea of some lines.
for tool in clang-format-14 clang-format none; do
  "$tool" --version 2>/dev/null | grep -q 'version 14\.' && break
done
[ "$tool" != none ] || { echo "Skipped: clang-format 14 is missing (Debian 12: scripts/setup test installs it)."; exit 77; }
find include src planners tests python bench -name '*.?pp' -o -name '*.inl' | sort | xargs "$tool" --dry-run -Werror
