"""Next-best view by information gain: the next pose has the largest ln det(I + J Σ Jᵀ), Σ the covariance so far, at first that of the tolerances."""
import numpy as np

import _task

folder, poses, out = _task.arguments()
J = _task.needed(folder, "blocks")
n, r, m = J.shape
rows = J.reshape(-1, m)
spread = rows.T @ rows / n
M = (np.load(folder / "prior.npy") if (folder / "prior.npy").is_file() else 0) + 1e-6 * spread + 1e-12 * np.eye(m)
chosen, free = [], np.ones(n, bool)
for _ in range(poses):
    V = rows @ np.linalg.inv(M)
    S = np.eye(r) + np.einsum("nrk,nsk->nrs", V.reshape(n, r, m), J)
    gain = np.where(free, np.linalg.slogdet(S)[1], -np.inf)
    best = int(np.argmax(gain))
    free[best] = False
    chosen.append(best)
    M = M + J[best].T @ J[best]
_task.write(out, chosen)
