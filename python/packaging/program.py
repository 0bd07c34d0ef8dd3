"""What `pip install` of the program's wheel puts beside its files: the program is started as a launcher in the same folder says."""
import os
import pathlib
import sys

FOLDER = pathlib.Path(__file__).resolve().parent


def main():
    launcher = str(FOLDER / "bin" / "posewright")
    try:
        os.execv("/bin/sh", ["sh", launcher, *sys.argv[1:]])
    except OSError as error:
        sys.exit(f"posewright: {launcher} cannot be started: {error.strerror}")
