"""scripts/apt-repository makes a signed repository for the tests beside this one: make_repository.py SOURCE BUILD FOLDER."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from debian import need, run

need(dpkg_shlibdeps="dpkg-dev", file="file", apt_ftparchive="apt-utils", gpg="gpg")
source, build, folder = map(pathlib.Path, sys.argv[1:])
shutil.rmtree(folder, ignore_errors=True)
with tempfile.TemporaryDirectory() as home:  # a key of this run alone; paths of its agent's sockets must be short
    keys = {**os.environ, "GNUPGHOME": home}
    run("gpg", "--batch", "--passphrase", "", "--quick-generate-key", "tests@posewright.example", "rsa2048", "sign", "1d", env=keys)
    said = run(source / "scripts/apt-repository", folder, build, env={**keys, "APT_KEY": "tests@posewright.example"})
    subprocess.run(["gpgconf", "--kill", "all"], env=keys)
names = {file.name for file in folder.iterdir()}
assert {"Packages", "Packages.gz", "Release", "InRelease", "Release.gpg", "posewright.asc"} < names, names
assert len([name for name in names if name.endswith(".deb")]) == 4 and not any(name.startswith(".new") for name in names)
assert f"deb [signed-by={folder}/posewright.asc] file:{folder} ./" in said, said
assert folder.joinpath("Packages").read_text().count("\nFilename: ./") == 4
