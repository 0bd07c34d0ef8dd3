# What the three scripts share: arguments, the clock, log det by QR of the chosen rows.
# The fifth word is a seed (without it: what R or the package starts with), the sixth a file for the chosen rows, counted from 0.
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
  columns <- length(strsplit(readLines(words[1], 1), ",")[[1]])
  x <- matrix(scan(words[1], sep = ",", quiet = TRUE), ncol = columns, byrow = TRUE)  # read.csv() would take more memory than the packages
  n <- as.integer(words[2])
  effort <- if (length(words) > 2) as.numeric(words[3]) else 1
  repeats <- length(words) > 3 && words[4] == "allow"
  if (length(words) > 4) set.seed(as.integer(words[5]))
  seconds <- system.time(rows <- search(x, n, effort, repeats))
  pivots <- abs(diag(qr.R(qr(x[rows, , drop = FALSE], LAPACK = TRUE))))
  if (length(words) > 5) write(rows - 1L, words[6], ncolumns = 1)
  cat(sprintf("%d rows, %d different, log det %.9f, %.2f s CPU\n", length(rows), length(unique(rows)), 2 * sum(log(pivots)), sum(seconds[1:2])))
}
