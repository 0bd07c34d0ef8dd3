# Rscript bench/peers/skpr.R INSTANCE.csv N [RUNS] [allow]
# The coordinate-free candidate search of skpr (Morgan-Wall & Khoury). Its candidate sets may be drawn from repeatedly.
source(file.path(dirname(sub("--file=", "", grep("--file=", commandArgs(FALSE), value = TRUE))), "common.R"))
need("skpr")
peer(function(x, n, runs, repeats) {
  data <- as.data.frame(x)
  names(data) <- paste0("x", seq_len(ncol(data)))
  model <- as.formula(paste("~", paste(names(data), collapse = " + "), "- 1"))
  chosen <- skpr::gen_design(data, model, trials = n, optimality = "D", repeats = runs, contrast = NULL)
  # The design comes back as rows: their places in the candidate set, by value.
  key <- function(d) do.call(paste, c(as.data.frame(d), sep = "\r"))
  match(key(chosen[, names(data)]), key(data))
})
