# What the three scripts share: arguments, the clock, log det by QR of the chosen rows.
need <- function(package) {
  if (requireNamespace(package, quietly = TRUE)) return(invisible())
  cat(package, "is not installed: install.packages(\"", package, "\")\n", sep = "")
  quit(status = 1)
}

peer <- function(search) {
  words <- commandArgs(TRUE)
  if (length(words) < 2) {
    cat("INSTANCE.csv and N are needed; see the first line of the script\n")
    quit(status = 2)
  }
  x <- as.matrix(read.csv(words[1], header = FALSE))
  n <- as.integer(words[2])
  effort <- if (length(words) > 2) as.numeric(words[3]) else 1
  repeats <- length(words) > 3 && words[4] == "allow"
  seconds <- system.time(rows <- search(x, n, effort, repeats))
  pivots <- abs(diag(qr.R(qr(x[rows, , drop = FALSE], LAPACK = TRUE))))
  cat(sprintf("%d rows, log det %.9f, %.2f s CPU\n", length(rows), 2 * sum(log(pivots)), sum(seconds[1:2])))
}
