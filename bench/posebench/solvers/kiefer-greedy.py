"""Greedy by Kiefer's rule: the next pose is the one of largest variance of prediction, trace J M⁻¹ Jᵀ (Kiefer & Wolfowitz 1960, Wynn 1970)."""
import numpy as np

import _task

folder, poses, out = _task.arguments()
J = _task.needed(folder, "blocks")
n, r, m = J.shape
rows = J.reshape(-1, m)
M = 1e-6 * rows.T @ rows / n + 1e-12 * np.eye(m)
chosen, free = [], np.ones(n, bool)
for _ in range(poses):
    gain = np.einsum("ij,ij->i", rows @ np.linalg.inv(M), rows).reshape(n, r).sum(1)
    best = int(np.argmax(np.where(free, gain, -np.inf)))
    free[best] = False
    chosen.append(best)
    M = M + J[best].T @ J[best]
_task.write(out, chosen)
