"""The documentation builds as a site without a warning: build_site.py SOURCE."""
import shutil
import subprocess
import sys
import tempfile

if shutil.which("mkdocs") is None:
    print("skipped: mkdocs is missing (Debian: mkdocs)")
    sys.exit(77)
with tempfile.TemporaryDirectory() as folder:
    sys.exit(subprocess.run(["mkdocs", "build", "--strict", "--quiet", "--site-dir", folder], cwd=sys.argv[1]).returncode)
