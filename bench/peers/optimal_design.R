# Rscript bench/peers/optimal_design.R INSTANCE.csv N [SECONDS] [forbid|allow]
# KL exchange as OptimalDesign has it (Harman & Filova), for SECONDS.
source(file.path(dirname(sub("--file=", "", grep("--file=", commandArgs(FALSE), value = TRUE))), "common.R"))
need("OptimalDesign")
peer(function(x, n, seconds, repeats) {
  found <- OptimalDesign::od_KL(x, n, bin = !repeats, t.max = max(seconds, 1), echo = FALSE)
  rep(seq_len(nrow(x)), round(found$w.best))
})
