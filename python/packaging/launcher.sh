#!/bin/sh
# posewright with the libraries that it needs, for any Linux with this machine and this C library or a later one.
needs_machine=@MACHINE@ needs_glibc=@GLIBC@
build_it='it can be built from source on Debian 12, Debian 13 and Ubuntu 24.04 (docs/install.md)'
machine=$(uname -m)
if [ "$machine" != "$needs_machine" ]; then
  echo "This posewright is for $needs_machine, this machine is $machine; $build_it" >&2
  exit 1
fi
library=$(getconf GNU_LIBC_VERSION 2>/dev/null)
case $library in
  'glibc '*) found=${library#glibc } ;;
  *) found=0.0 library='another C library' ;;
esac
if [ "${found%%.*}" -lt "${needs_glibc%%.*}" ] || { [ "${found%%.*}" -eq "${needs_glibc%%.*}" ] && [ "${found#*.}" -lt "${needs_glibc#*.}" ]; }; then
  echo "This posewright needs glibc $needs_glibc or later (Debian 12, Ubuntu 22.04, Fedora 36 and later); this system has $library" >&2
  exit 1
fi
here=$(dirname "$(readlink -f "$0")")
exec "$here/../libexec/posewright" "$@"
