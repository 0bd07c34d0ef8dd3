"""Selection as FIGAROH does it (optimal_config): D-optimal weights of all candidates, then those of largest weight. Restated here:
FIGAROH solves a conic program for the weights, this the multiplicative algorithm (Silvey, Titterington & Torsney 1978)."""
import numpy as np

import _task


def optimal_weights(J, tolerance=1e-3, rounds=3000):
    """Candidates that cannot carry weight are dropped on the way (Harman & Pronzato 2007; of blocks Harman & Trnovská 2009)."""
    n, r, m = J.shape
    kept, w = np.arange(n), np.full(n, 1.0 / n)
    rows = J
    for step in range(rounds):
        flat = rows.reshape(-1, m)
        M = flat.T @ (np.repeat(w, r)[:, None] * flat)
        V = flat @ np.linalg.inv(np.linalg.cholesky(M)).T
        d = (V ** 2).sum(1).reshape(-1, r).sum(1)
        gap = d.max() / m - 1
        if gap <= tolerance:
            break
        w = w * d / m
        if step % 20 == 19:
            may = d >= m * (1 + gap * m / 2 - np.sqrt(gap * m * (4 + gap * m - 4 / m)) / 2)
            kept, w, rows = kept[may], w[may] / w[may].sum(), rows[may]
    every = np.zeros(n)
    every[kept] = w
    return every


folder, poses, out = _task.arguments()
J = _task.needed(folder, "blocks")
_, triangle = np.linalg.qr(J.reshape(-1, J.shape[2]))
J = np.linalg.solve(triangle.T, J.reshape(-1, J.shape[2]).T).T.reshape(J.shape) * np.sqrt(len(J))
_task.write(out, np.argsort(-optimal_weights(J), kind="stable")[:poses])
