"""measure.py USAGE SECONDS COMMAND…: runs COMMAND for at most so many CPU seconds; USAGE gets exit code, CPU seconds, MiB.

A process of its own, because the memory of a large parent would count as that of its child."""
import json
import os
import pathlib
import resource
import signal
import sys

usage, seconds, *command = sys.argv[1:]
child = os.fork()
if child == 0:
    resource.setrlimit(resource.RLIMIT_CPU, (int(float(seconds)) + 1, int(float(seconds)) + 2))
    os.execv(command[0], command)
_, status, used = os.wait4(child, 0)
cpu, code = used.ru_utime + used.ru_stime, os.waitstatus_to_exitcode(status)
late = code in (-signal.SIGXCPU, -signal.SIGKILL) or (code != 0 and cpu > float(seconds))
pathlib.Path(usage).write_text(json.dumps({"code": code, "late": late, "cpu": cpu, "memory": used.ru_maxrss / 1024}))
