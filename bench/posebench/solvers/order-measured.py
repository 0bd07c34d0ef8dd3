"""The first poses in the order of the list."""
import _task

folder, poses, out = _task.arguments()
_task.needed(folder, "joints")
_task.write(out, range(poses))
