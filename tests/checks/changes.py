"""What the checks of sources have in common: what the last commit changed, and how the build includes."""
import pathlib
import re
import subprocess


def changed(root):
    """Names of files that differ from the parent commit; None without history."""
    run = subprocess.run(["git", "-C", str(root), "diff", "--name-only", "--diff-filter=d", "HEAD~1"], capture_output=True, text=True)
    return run.stdout.split() if run.returncode == 0 else None


def include_flags(build):
    """Folders that the sources are compiled with, from the build's own list."""
    text = (pathlib.Path(build) / "compile_commands.json").read_text()
    own, system = set(re.findall(r"-I[^ \"]+", text)), set(re.findall(r"-isystem ([^ \"]+)", text)) - {"/usr/include"}
    return sorted(own) + [word for folder in sorted(system) for word in ("-isystem", folder)]
