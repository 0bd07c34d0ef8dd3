# Rscript bench/peers/skpr.R INSTANCE.csv N [RUNS] [forbid or allow] [SEED] [ROWS]
# The candidate search of skpr (Morgan-Wall & Khoury). Its sets may hold a candidate more than once, whatever the fourth word.
source(file.path(dirname(sub("--file=", "", grep("--file=", commandArgs(FALSE), value = TRUE))), "common.R"))
need("skpr")
peer(function(x, n, runs, repeats) {
  # gen_design() would shift each column to the middle of its range, which changes log det of a model without intercept, refuse a
  # constant column, and build all interactions. The search that it calls, and its way to start it and to keep the best, are used.
  found <- list(criterion = -Inf)
  for (run in seq_len(runs)) {
    start <- sample(nrow(x), n)
    one <- x[, 1, drop = FALSE]  # in place of the aliased model: copied, not used for criterion D
    tried <- skpr:::genOptimalDesign(x[start, ], x, "D", crossprod(x) / nrow(x), start, one[start, , drop = FALSE], one,
                                     minDopt = 0.8, tolerance = 10e-5, augmentedrows = 0L, kexchange = n)
    if (!is.na(tried$criterion) && tried$criterion > found$criterion) found <- tried
  }
  as.integer(round(found$indices))
})
