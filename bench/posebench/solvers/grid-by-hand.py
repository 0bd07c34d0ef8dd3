"""A grid over the box of the tip's positions; at each node the nearest pose that is not taken. The longest edges get the most nodes."""
import itertools

import numpy as np

import _task

folder, poses, out = _task.arguments()
tips = _task.needed(folder, "tips")
low, size = tips.min(0), np.ptp(tips, axis=0)
count = np.ones(3, int)
while count.prod() < poses:
    count[np.argmax(size / count)] += 1
nodes = np.array(list(itertools.product(*[(np.arange(k) + 0.5) / k for k in count])))
nodes = low + size * nodes[np.linspace(0, len(nodes) - 1, poses).round().astype(int)]
chosen, free = [], np.ones(len(tips), bool)
for node in nodes:
    nearest = int(np.argmin(np.where(free, ((tips - node) ** 2).sum(1), np.inf)))
    free[nearest] = False
    chosen.append(nearest)
_task.write(out, chosen)
