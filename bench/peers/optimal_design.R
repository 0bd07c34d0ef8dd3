# Rscript bench/peers/optimal_design.R INSTANCE.csv N [SECONDS] [forbid or allow] [SEED] [ROWS]
# KL exchange as OptimalDesign has it (Harman & Filova), for SECONDS of the processor: on a busy machine it gets no less.
source(file.path(dirname(sub("--file=", "", grep("--file=", commandArgs(FALSE), value = TRUE))), "common.R"))
need("OptimalDesign")
clock <- new.env(parent = environment(OptimalDesign::od_KL))
clock$proc.time <- function() { now <- base::proc.time(); now[3] <- now[1] + now[2]; now }
for (name in c("od_KL", "od_D_KL", "od_D_KL_bin")) {
  own <- get(name, envir = asNamespace("OptimalDesign"))
  environment(own) <- clock  # the package's functions as they are, with that clock
  assign(name, own, envir = clock)
}
peer(function(x, n, seconds, repeats) {
  found <- clock$od_KL(x, n, bin = !repeats, t.max = max(seconds, 1), echo = FALSE)
  rep(seq_len(nrow(x)), round(found$w.best))
})
