#!/bin/sh
# other_debian.sh SOURCE: `scripts/test debian13`, or `debian12` where this is Debian 13. 77: it cannot be done here.
set -eu
number=13
! grep -q '^VERSION_CODENAME=trixie' /etc/os-release || number=12
exec "$1/scripts/test" debian$number
