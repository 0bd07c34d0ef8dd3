"""Each next pose is farthest in joint space from those before; the first is nearest to the middle. Joints count by their range."""
import numpy as np

import _task

folder, poses, out = _task.arguments()
q = _task.needed(folder, "joints")
q = (q - q.mean(0)) / np.maximum(np.ptp(q, axis=0), 1e-12)
chosen = [int(np.argmin((q ** 2).sum(1)))]
distance = np.full(len(q), np.inf)
while len(chosen) < poses:
    distance = np.minimum(distance, ((q - q[chosen[-1]]) ** 2).sum(1))
    distance[chosen] = -1
    chosen.append(int(np.argmax(distance)))
_task.write(out, chosen)
