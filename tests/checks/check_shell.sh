#!/bin/sh
# check_shell.sh SOURCE: shellcheck has nothing to say of the shell scripts. 77: the tool is missing.
set -eu
cd "$1"
command -v shellcheck >/dev/null || { echo "Skipped: shellcheck is missing (scripts/setup test installs it)."; exit 77; }
grep -l '^#!.*sh$' .ci/run scripts/* bench/*.sh tests/checks/*.sh | xargs shellcheck
