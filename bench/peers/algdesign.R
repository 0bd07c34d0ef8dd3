# Rscript bench/peers/algdesign.R INSTANCE.csv N [RUNS] [forbid or allow] [SEED] [ROWS]
# Fedorov's exchange as AlgDesign has it (Wheeler 2004), on rows of a CSV file without header.
source(file.path(dirname(sub("--file=", "", grep("--file=", commandArgs(FALSE), value = TRUE))), "common.R"))
need("AlgDesign")
peer(function(x, n, runs, repeats) {
  if (repeats) stop("optFederov takes each candidate once")
  data <- as.data.frame(x)
  found <- AlgDesign::optFederov(~ . - 1, data, nTrials = n, nRepeats = runs, center = FALSE, criterion = "D")
  found$rows
})
